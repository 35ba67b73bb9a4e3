#include "sim/left_out.h"

#include <algorithm>

namespace splatscope::sim {
namespace {

class List {
 public:
  List(const Trace& trace, std::span<const DrawJob> jobs) : trace_(trace), jobs_(jobs) {}

  void add_unit(std::string name, std::string why) { list_.push_back({std::move(name), std::move(why)}); }

  // What is in the way of some draws and not of these.
  template <class Without>
  void add_draws(const std::string& name, Without without, std::string why) {
    add_some(name + " in ", std::ranges::count_if(jobs_, without), std::ssize(jobs_), " draws",
             std::move(why));
  }

  void add_triangles() {
    std::uint64_t triangles = 0, clipped = 0;
    for (const DrawJob& job : jobs_) {
      triangles += job.draw->index_count / 3;
      clipped += job.triangles_clipped;
    }
    add_some("clipping of ", triangles - clipped, triangles, " triangles",
             "each stays one piece or is rejected");
  }

  bool reads_agp(const DrawJob& job) const {
    return trace_.buffers[job.draw->vertex_buffer].place == MemoryPlace::agp ||
           trace_.buffers[job.draw->index_buffer].place == MemoryPlace::agp;
  }
  bool any_blends() const {
    return std::ranges::any_of(
        jobs_, [](const DrawJob& job) { return job.draw->state.color_write && job.draw->state.blend; });
  }
  std::vector<UnitLeftOut> take() { return std::move(list_); }

 private:
  template <class Count>
  void add_some(const std::string& name, Count some, Count all, const std::string& items, std::string why) {
    if (some > 0)
      add_unit(name + std::to_string(some) + " of " + std::to_string(all) + items, std::move(why));
  }

  const Trace& trace_;
  std::span<const DrawJob> jobs_;
  std::vector<UnitLeftOut> list_;
};

void add_color(List& list, const Needs& built) {
  const auto is_dark = [](const DrawJob& job) { return !job.draw->state.color_write; };
  list.add_draws(built.texture ? "texture, pixel and blend" : "pixel and blend", is_dark,
                 "they write no colour");
  if (built.texture) {
    list.add_draws(
        "texture", [&](const DrawJob& job) { return !is_dark(job) && !job.textured; },
        "they write colour and sample no texture");
  }
  if (!list.any_blends()) return list.add_unit("destination read", "no draw blends");
  list.add_draws(
      "destination read", [&](const DrawJob& job) { return !is_dark(job) && !job.draw->state.blend; },
      "they write colour without blending");
}

}  // namespace

std::vector<UnitLeftOut> left_out(const Trace& trace, const Needs& built, std::span<const DrawJob> jobs) {
  List list(trace, jobs);
  if (!built.agp) list.add_unit("agp", "every buffer is in video memory");
  if (!built.depth) list.add_unit("depth", "no draw tests or writes depth");
  if (!built.color) {
    for (const char* name : {"texture", "pixel", "blend"}) list.add_unit(name, "no draw writes colour");
  } else if (!built.texture) {
    list.add_unit("texture", "no draw that writes colour samples a texture");
  }
  if (built.agp) {
    list.add_draws(
        "agp", [&](const DrawJob& job) { return !list.reads_agp(job); }, "their buffers are in video memory");
  }
  if (built.depth) {
    list.add_draws(
        "depth", [](const DrawJob& job) { return !uses_depth(*job.draw); },
        "they neither test nor write depth");
  }
  if (built.color) add_color(list, built);
  list.add_triangles();
  return list.take();
}

}  // namespace splatscope::sim
