#include "sim/fidelity/thinning.h"

#include <algorithm>
#include <utility>

#include "sim/draw_jobs.h"

namespace splatscope::sim {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

void ThinParts::begin(DrawJob& job, std::vector<Span> kept, Stretches* stretches) {
  job_ = &job;
  if (kept.empty()) kept.push_back({0, job.draw->index_count / 3});
  kept_ = std::move(kept);
  next_kept_ = 0;
  stretches_ = stretches;
  part_ = nullptr;
  part_begin_ = 0;
  std::uint64_t triangles = 0;
  for (const Span& span : kept_) triangles += span.to - span.from;
  window_.begin(job, triangles, *this);
  take();
}

// Until there is something that is kept.
void ThinParts::take() {
  for (;;) {
    if (part_ == nullptr) next_part();
    const std::uint64_t triangle = part_begin_ + at_.triangle;
    while (next_kept_ + 1 != kept_.size() && triangle >= kept_[next_kept_].to) ++next_kept_;
    const auto [from, to] = kept_[next_kept_];
    const auto in_part = [&](std::uint64_t end) {
      return std::min<std::size_t>(end - part_begin_, part_->triangles.size());
    };
    if (triangle >= from) return keep(in_part(to));
    leave_out(in_part(from));
  }
}

void ThinParts::next_part() {
  part_ = &next_();
  at_ = {};
  expect_part(*job_, *part_, part_begin_);
  job_->triangles_clipped += clipped_triangles(*part_);
  if (stretches_ != nullptr) stretches_->add(*part_);
}

ThinParts::Place ThinParts::find(std::size_t triangle) const {
  Place at = at_;
  const std::size_t first_quad = at.quad;
  for (; at.triangle < triangle; ++at.triangle) {
    at.vertex += part_->triangles[at.triangle].new_vertices;
    at.quad += part_->triangles[at.triangle].quad_count;
  }
  for (std::size_t quad = first_quad; quad < at.quad; ++quad)
    at.block += part_->quads[quad].texel_block_count;
  return at;
}

void ThinParts::go_to(const Place& end) {
  at_ = end;
  if (end.triangle != part_->triangles.size()) return;
  part_begin_ += end.triangle;
  part_ = nullptr;
}

void ThinParts::leave_out(std::size_t triangle) {
  const Place end = find(triangle);
  Cut& cut = window_.leave_out();
  append(cut.vertices, part_->shaded_vertices, at_.vertex, end.vertex);
  append(cut.quads, part_->quads, at_.quad, end.quad);
  append(cut.blocks, part_->texel_blocks, at_.block, end.block);
  go_to(end);
}

void ThinParts::keep(std::size_t triangle) {
  const Place end = find(triangle);
  if (at_.triangle == 0 && triangle == part_->triangles.size()) {
    window_.add(*part_);
  } else {
    some_ = {};
    append(some_.triangles, part_->triangles, at_.triangle, end.triangle);
    append(some_.shaded_vertices, part_->shaded_vertices, at_.vertex, end.vertex);
    append(some_.quads, part_->quads, at_.quad, end.quad);
    append(some_.texel_blocks, part_->texel_blocks, at_.block, end.block);
    window_.add(some_);
  }
  go_to(end);
}

}  // namespace splatscope::sim
