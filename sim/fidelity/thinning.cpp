#include "sim/fidelity/thinning.h"

namespace splatscope::sim {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

ThinDraw::ThinDraw(const DrawJob& whole) : whole_(whole) {
  work_.command = whole.work->command;
}

ThinDraw::Place ThinDraw::find(const DrawWork& work, Place at, std::size_t triangle) {
  const std::size_t first_quad = at.quad;
  for (; at.triangle < triangle; ++at.triangle) {
    at.vertex += work.triangles[at.triangle].new_vertices;
    at.quad += work.triangles[at.triangle].quad_count;
  }
  for (std::size_t quad = first_quad; quad < at.quad; ++quad) at.block += work.quads[quad].texel_block_count;
  return at;
}

void ThinDraw::keep(std::size_t from, std::size_t to) {
  const DrawWork& work = *whole_.work;
  const Place begin = find(work, end_, from);
  const Place end = find(work, begin, to);
  if (begin.triangle != end_.triangle) {
    cuts_.push_back({static_cast<std::uint32_t>(work_.shaded_vertices.size()),
                     static_cast<std::uint32_t>(work_.quads.size()),
                     std::span(work.shaded_vertices).subspan(end_.vertex, begin.vertex - end_.vertex),
                     std::span(work.quads).subspan(end_.quad, begin.quad - end_.quad),
                     std::span(work.texel_blocks).subspan(end_.block, begin.block - end_.block)});
  }
  marks_.push_back(static_cast<std::uint32_t>(work_.triangles.size()));
  append(work_.triangles, work.triangles, begin.triangle, end.triangle);
  append(work_.shaded_vertices, work.shaded_vertices, begin.vertex, end.vertex);
  append(work_.quads, work.quads, begin.quad, end.quad);
  append(work_.texel_blocks, work.texel_blocks, begin.block, end.block);
  end_ = end;
}

DrawJob ThinDraw::job() {
  DrawJob job = whole_;
  job.work = &work_;
  job.cuts = cuts_;
  job.marks = marks_;
  show_all(job, work_);
  return job;
}

}  // namespace splatscope::sim
