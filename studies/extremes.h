#pragma once

#include <functional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/object_space_ewa/quad_runner.h"
#include "studies/study.h"

// Where the formulas of Ren 2002 break, and what repairs cost.
namespace splatscope::studies {

// Worst over the surfels of one point of a sweep; relative, INFINITY where something is not finite.
struct ExtremeErrors {
  double deviation = 0;  // of the standard deviation in any direction of the screen
  double weight = 0;     // of 1/(2 pi r0 r1)

  double worst() const { return deviation > weight ? deviation : weight; }
};

// What computes a splat: a vertex program in an arithmetic, or the formulas as Appendix A prints them.
struct Splatter {
  std::string name;  // "paper, nv20"
  std::function<ExtremeErrors(const kernels::View&, std::span<const kernels::Surfel>)> errors;
};
std::vector<Splatter> splatters();

// One quantity taken from usual to extreme, with everything else usual.
struct ExtremeSweep {
  std::string name;  // "cosine", with its unit
  std::vector<double> values;
  std::function<kernels::View(double)> view;
  std::function<kernels::Surfel(const kernels::View&, double, std::mt19937&)> surfel;
};
std::vector<ExtremeSweep> extreme_sweeps();

struct ExtremeRow {
  std::string sweep, splatter;
  std::vector<double> values, errors;  // worst()
  // The first value whose error is over 1 %, 10 %, and all bounds (100 % or not finite); NaN where none is.
  double over_1 = 0, over_10 = 0, over_all = 0;
};
ExtremeRow sweep_row(const ExtremeSweep& sweep, const Splatter& splatter, int surfels_a_value, unsigned seed);

// A program with a guard taken out or put in, as edits of its text, and what the guard is worth on surfels of
// all kinds.
struct Guard {
  std::string name;
  std::string_view program;                                  // kernels::ewa_programs()
  std::vector<std::pair<std::string, std::string>> without;  // text and what replaces it
  std::string repairs;
};
std::vector<Guard> guards();

struct GuardRow {
  Guard guard;
  int slots = 0;  // that it costs
  // Of the surfels, with the guard and without: not finite; more than 10 % off; wider than the frame where
  // the exact filter is not.
  struct Counts {
    int not_finite = 0, off = 0, too_wide = 0;
  } with, without;
};
GuardRow guard_row(const Guard& guard, Arithmetic arithmetic, int surfels, unsigned seed);

std::string line_of(const GuardRow& row, std::string_view arithmetic);

// Of the study.
inline constexpr int kSurfelsAValue = 500;
inline constexpr unsigned kExtremesSeed = 2002;

void study_extremes(Findings& findings, const Progress& progress);

}  // namespace splatscope::studies
