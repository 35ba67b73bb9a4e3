#include "sim/work_window.h"

#include <algorithm>
#include <bit>
#include <string>

#include "model/error.h"
#include "sim/draw_jobs.h"

namespace splatscope::sim {

template <class T>
void RecordRing<T>::append(std::span<const T> more) {
  if (end_ - begin_ + more.size() > slots_.size()) {
    std::vector<T> larger(std::bit_ceil(end_ - begin_ + more.size()));
    for (std::uint64_t i = begin_; i != end_; ++i)
      larger[i & (larger.size() - 1)] = slots_[i & (slots_.size() - 1)];
    slots_ = std::move(larger);
  }
  if (more.empty()) return;
  const std::uint64_t first = end_ & (slots_.size() - 1);
  const std::span to_the_end = more.first(std::min<std::size_t>(more.size(), slots_.size() - first));
  std::ranges::copy(to_the_end, slots_.begin() + static_cast<std::ptrdiff_t>(first));
  std::ranges::copy(more.subspan(to_the_end.size()), slots_.begin());
  end_ += more.size();
}

void WorkWindow::begin(DrawJob& job, std::uint64_t triangles, MoreWork& rest) {
  job_ = &job;
  parts_.clear();
  triangles_.clear();
  shaded_vertices_.clear();
  quads_.clear();
  texel_blocks_.clear();
  cuts_.clear();
  job.cuts = &cuts_;
  job.all_triangles = triangles;
  job.rest = &rest;
}

void WorkWindow::add(const DrawWork& part) {
  forget();
  triangles_.append(part.triangles);
  shaded_vertices_.append(part.shaded_vertices);
  quads_.append(part.quads);
  texel_blocks_.append(part.texel_blocks);
  job_->triangles = triangles_.records();
  job_->shaded_vertices = shaded_vertices_.records();
  job_->quads = quads_.records();
  job_->texel_blocks = texel_blocks_.records();
  job_->counts += counts_of(part, *job_->draw);
  Ends ends{triangles_.end(), shaded_vertices_.end(), quads_.end(), texel_blocks_.end(), {}};
  for (const DrawUnit* unit : units_) ends.items.push_back(unit->items(*job_));
  parts_.push_back(std::move(ends));
}

Cut& WorkWindow::leave_out() {
  return cuts_.add(static_cast<std::uint32_t>(shaded_vertices_.end()),
                   static_cast<std::uint32_t>(quads_.end()));
}

void WorkWindow::forget() {
  const auto is_done = [&](const Ends& ends) {
    for (std::size_t i = 0; i < units_.size(); ++i)
      if (units_[i]->items_done(*job_) < ends.items[i]) return false;
    return true;
  };
  for (; !parts_.empty() && is_done(parts_.front()); parts_.pop_front()) {
    triangles_.forget(parts_.front().triangles);
    shaded_vertices_.forget(parts_.front().shaded_vertices);
    quads_.forget(parts_.front().quads);
    texel_blocks_.forget(parts_.front().texel_blocks);
  }
  std::uint64_t passed = cuts_.end();
  for (const DrawUnit* unit : units_) passed = std::min(passed, unit->cuts_passed(*job_));
  cuts_.forget(passed);
}

void expect_part(const DrawJob& job, const DrawWork& part, std::uint64_t triangles_before) {
  if (part.command != job.command)
    throw ModelError("the work of command " + std::to_string(job.command) +
                     " of the trace is followed by that of command " + std::to_string(part.command));
  const std::uint64_t all = job.draw->index_count / 3;
  if (part.samples_only || !adds_up(part) || triangles_before + part.triangles.size() > all ||
      (part.triangles.empty() && all != 0))
    throw ModelError("a part of the work of command " + std::to_string(part.command) + " does not add up");
}

void WorkParts::begin(DrawJob& job) {
  job_ = &job;
  window_.begin(job, job.draw->index_count / 3, *this);
  take();
}

void WorkParts::take() {
  const DrawWork& part = next_();
  expect_part(*job_, part, job_->counts.triangles);
  job_->triangles_clipped += clipped_triangles(part);
  window_.add(part);
}

}  // namespace splatscope::sim
