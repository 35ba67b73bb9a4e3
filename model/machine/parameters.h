#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "model/machine/machine.h"

namespace splatscope::machine {

struct IntegerField {
  int (*get)(const Machine&);
  void (*set)(Machine&, int);
  int least, most;
  bool power_of_two = false;  // address arithmetic splits it by bits
};
struct RealField {
  double (*get)(const Machine&);
  void (*set)(Machine&, double);
  double least, most;
};
struct SwitchField {
  bool (*get)(const Machine&);
  void (*set)(Machine&, bool);
};
// One of a few names, kept as an enumeration: the place of the name in `names` is its value.
struct ChoiceField {
  std::span<const std::string_view> names;
  int (*get)(const Machine&);
  void (*set)(Machine&, int);
};

// The one declaration of a parameter: its name in files, its unit, where it is kept, what it may be, what it
// does. Its default is the member's initialiser in machine.h.
struct Parameter {
  std::string_view name;
  std::string_view unit;
  std::variant<IntegerField, RealField, SwitchField, ChoiceField> field;
  std::string_view what;
};

std::span<const Parameter> parameters();

std::string_view name(FrameFormat format);  // as numbers.frame has it

}  // namespace splatscope::machine
