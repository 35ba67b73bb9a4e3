#include "sim/work_parts.h"

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

void WorkParts::begin(DrawJob& job) {
  job_ = &job;
  parts_.clear();
  triangles_.clear();
  shaded_vertices_.clear();
  quads_.clear();
  texel_blocks_.clear();
  job.all_triangles = job.draw->index_count / 3;
  job.rest = this;
  take();
}

void WorkParts::take() {
  forget();
  const DrawWork& part = next_();
  if (part.command != job_->command)
    throw ModelError("the work of command " + std::to_string(job_->command) +
                     " of the trace is followed by that of command " + std::to_string(part.command));
  const DrawCounts more = counts_of(part, *job_->draw);
  DrawCounts& counts = job_->counts;
  if (part.samples_only || !adds_up(part) || counts.triangles + more.triangles > job_->all_triangles ||
      (more.triangles == 0 && job_->all_triangles != 0))
    throw ModelError("a part of the work of command " + std::to_string(part.command) + " does not add up");
  triangles_.append(part.triangles);
  shaded_vertices_.append(part.shaded_vertices);
  quads_.append(part.quads);
  texel_blocks_.append(part.texel_blocks);
  job_->triangles = triangles_.records();
  job_->shaded_vertices = shaded_vertices_.records();
  job_->quads = quads_.records();
  job_->texel_blocks = texel_blocks_.records();
  job_->triangles_clipped += clipped_triangles(part);
  counts += more;
  Ends ends{triangles_.end(), shaded_vertices_.end(), quads_.end(), texel_blocks_.end(), {}};
  for (const DrawUnit* unit : units_) ends.items.push_back(unit->items(*job_));
  parts_.push_back(std::move(ends));
}

void WorkParts::forget() {
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
}

}  // namespace splatscope::sim
