#include "model/draw.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/clear_tiles.h"
#include "model/fragment_pipe.h"
#include "model/geometry.h"
#include "model/output/output.h"
#include "model/stop.h"

namespace splatscope {
namespace {

// So many for each thread: with more the caches hold less of them, with fewer threads wait for one another.
constexpr std::size_t kBatchesAThread = 2;
// Pixels of the rectangles of a batch's triangles: with more its fragments are not kept until it is their
// turn to be written.
constexpr std::int64_t kMostPixelsKept = 1 << 18;

// Of a batch that is not kept, a part of its record is given away as soon as it holds so many quads.
constexpr std::size_t kQuadsAPart = 1 << 14;

// Windows of one piece of a triangle in one band.
struct Band {
  std::size_t piece = 0;
  bool noted = false;     // its quads go into the work record
  std::size_t count = 0;  // of windows
};

using Windows = std::span<raster::Window, raster::kMaxWindows>;

// A draw on its way, of which batches are in flight.
struct DrawInFlight {
  DrawInFlight(DrawTask task, Frame& target, Record noted)
      : bindings(task.bindings),
        frame(target),
        record(std::move(task.work)),
        depth{target.depth,
              {target.width, target.height},
              target.formats.depth,
              bindings.draw.state.depth_test,
              bindings.draw.state.depth_write} {
    if (noted == Record::nothing) return;
    record.samples_only = noted == Record::samples;
    if (uses_depth(bindings.draw)) clear_tiles.emplace(target);
  }

  DrawBindings bindings;
  Frame& frame;
  DrawWork record;            // what is the same in each part of it
  std::size_t triangles = 0;  // rasterised so far
  raster::DepthTarget depth;
  std::optional<ClearTiles> clear_tiles;  // where depth is recorded
};

// A batch of triangles on its way.
class Batch {
 public:
  void bind(std::shared_ptr<DrawInFlight> next) {
    draw = std::move(next);
    geometry.bind(draw->bindings);
    packs_ = output::packs(state(), draw->frame.formats);
  }

  void begin(bool write_at_once) {
    at_once = write_at_once;
    vertices_given_ = 0;
    begin_part();
    window_count_ = 0;
    bands.clear();
    pixels_.clear();
  }

  // Gives away what is noted, if there is something; a draw of nothing gives that.
  void give_part(const DrawPipeline::Done& done) {
    if (part.triangles.empty() && draw->bindings.draw.index_count != 0) return;
    if (!part.samples_only) {
      const auto first = geometry.shaded_vertices.begin() + vertices_given_;
      for (const TriangleWork& triangle : part.triangles) vertices_given_ += triangle.new_vertices;
      part.shaded_vertices.assign(first, geometry.shaded_vertices.begin() + vertices_given_);
    }
    done(part);
    begin_part();
  }

  // Room for the windows of one band; they are kept once it is added.
  Windows room() {
    if (windows_.size() < window_count_ + raster::kMaxWindows)
      windows_.resize(window_count_ + window_count_ / 2 + raster::kMaxWindows);
    return std::span(windows_).subspan(window_count_).first<raster::kMaxWindows>();
  }
  void add(const Band& band) {
    bands.push_back(band);
    window_count_ += band.count;
  }
  std::span<const raster::Window> windows() const { return std::span(windows_).first(window_count_); }

  // What is shaded: it is written at once, or waits for write().
  void take(const FragmentPipe::Colors& colors, std::span<const std::uint32_t> pixels) {
    if (at_once) return output::write_colors(colors, pixels, state(), draw->frame);
    const std::size_t first = pixels_.size();
    pixels_.insert(pixels_.end(), pixels.begin(), pixels.end());
    const auto room = [&](auto& values) {
      values.resize(pixels_.size() + output::kLanes);
      return values.data() + first;
    };
    if (packs_) return output::pack_colors(colors, pixels.size(), state(), room(packed_));
    for (std::size_t c = 0; c < 4; ++c) std::copy_n(colors[c], pixels.size(), room(colors_[c]));
  }
  void write() {
    if (packs_) return output::write_packed(packed_, pixels_, state(), draw->frame);
    const auto& [r, g, b, a] = colors_;
    output::write_colors({r.data(), g.data(), b.data(), a.data()}, pixels_, state(), draw->frame);
  }

  // Orders its last stage before the next filling: oneTBB counts the tokens, but its count releases nothing.
  void hand_back() { handed_back_.store(true, std::memory_order_release); }
  void take_again() { handed_back_.exchange(false, std::memory_order_acquire); }

  const DrawState& state() const { return draw->bindings.draw.state; }

  std::shared_ptr<DrawInFlight> draw;
  GeometryBatch geometry;
  DrawWork part;         // of the draw's record: what is noted and not given away
  bool at_once = false;  // depth, shading and writing together, when its turn to be written comes
  std::vector<Band> bands;

 private:
  void begin_part() {
    const DrawWork& record = draw->record;
    part.command = record.command;
    part.sampled_runs_apart = record.sampled_runs_apart;
    part.samples_only = record.samples_only;
    part.shaded_vertices.clear();  // and keep their memory
    part.triangles.clear();
    part.quads.clear();
    part.texel_blocks.clear();
    part.clear_tiles.clear();
  }

  std::ptrdiff_t vertices_given_ = 0;    // of the shaded ones
  std::vector<raster::Window> windows_;  // of all bands
  std::size_t window_count_ = 0;
  // What is shaded and waits to be written, in order: each fragment's pixel, and its colour in one form.
  bool packs_ = false;
  std::vector<std::uint32_t> pixels_, packed_;
  std::array<std::vector<float>, 4> colors_;
  std::atomic<bool> handed_back_ = true;
};

// A stage that is bound to a draw, and to the next one that it is asked to work on.
template <typename Stage>
class OfDraws {
 public:
  template <typename... Arguments>
  explicit OfDraws(const Arguments&... arguments) : stage_(arguments...) {}

  Stage& of(const std::shared_ptr<DrawInFlight>& draw) {
    if (draw == draw_) return stage_;
    stage_.bind(draw->bindings);
    draw_ = draw;  // after that: it looks at the one before
    return stage_;
  }

 private:
  Stage stage_;
  std::shared_ptr<DrawInFlight> draw_;
};

// What a thread works with, on one batch after the other.
class Worker {
 public:
  Worker(const RenderOptions& options, std::uint32_t width, std::uint32_t height)
      : geometry_(options, primitive::Viewport{width, height}), pipe_(width, options.formats) {}

  void process(Batch& batch) { geometry_.of(batch.draw).process(batch.geometry); }
  FragmentPipe& pipe(Batch& batch) {
    FragmentPipe& pipe = pipe_.of(batch.draw);
    pipe.begin(batch.geometry.attributes(),
               [&batch](const auto& colors, auto pixels) { batch.take(colors, pixels); });
    return pipe;
  }

 private:
  OfDraws<Geometry> geometry_;
  OfDraws<FragmentPipe> pipe_;
};

// The stages behind the geometry: depth is tested and colours are written batch by batch, in their order;
// what lies between knows no order.
class LaterStages {
 public:
  LaterStages(Record record, RenderCounters& counters) : record_(record), counters_(counters) {}

  // `done` takes what is noted from now on.
  void begin(const DrawPipeline::Done& done) { done_ = &done; }

  // One batch at a time.
  void test_depth(Batch& batch) {
    // Behind one whose depth is still to be tested all have to wait with theirs.
    batch.begin(waiting_.load(std::memory_order_acquire) != 0 ||
                batch.geometry.pixels_at_most() > kMostPixelsKept);
    if (batch.at_once) {
      waiting_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    rasterize(
        batch, [&] { return batch.room(); }, [&](const Band& band) { batch.add(band); }, [] {});
  }

  // Any number of batches at a time.
  static void shade(Batch& batch, Worker& worker) {
    if (batch.at_once) return;
    FragmentPipe& pipe = worker.pipe(batch);
    std::size_t first = 0;
    for (const Band& band : batch.bands) {
      push(pipe, batch, band, batch.windows().subspan(first, band.count));
      first += band.count;
    }
    pipe.flush();
  }

  // One batch at a time.
  void write(Batch& batch, Worker& worker) {
    if (batch.at_once) {
      do_at_once(batch, worker.pipe(batch));
      waiting_.fetch_sub(1, std::memory_order_release);
    } else {
      batch.write();
    }
    give_part(batch);
  }

  // All of it, where there is but one thread.
  void test_shade_and_write(Batch& batch, Worker& worker) {
    batch.begin(true);
    do_at_once(batch, worker.pipe(batch));
    give_part(batch);
  }

 private:
  static void push(FragmentPipe& pipe, Batch& batch, const Band& band,
                   std::span<const raster::Window> windows) {
    pipe.push_band(batch.geometry.piece(band.piece), windows, band.noted ? &batch.part : nullptr);
  }

  void do_at_once(Batch& batch, FragmentPipe& pipe) {
    rasterize(
        batch, [&] { return Windows(windows_); },
        [&](const Band& band) { push(pipe, batch, band, std::span(windows_).first(band.count)); },
        [&] {
          if (batch.part.quads.size() < kQuadsAPart) return;
          pipe.flush();
          give_part(batch);
        });
    pipe.flush();
  }

  // Who takes it may use oneTBB too, and is not to take up other stages while it waits there.
  void give_part(Batch& batch) const {
    if (record_ == Record::nothing) return;
    tbb::this_task_arena::isolate([&] { batch.give_part(*done_); });
  }

  // Whether the draw's cull mode drops a piece. What decides is the sign on the grid that decides coverage,
  // so a triangle that is dropped and its neighbour that is not never share a pixel.
  static bool culled(const raster::TriangleSetup& piece, CullMode mode) {
    switch (mode) {
      case CullMode::clockwise:
        return piece.winding > 0;
      case CullMode::counter_clockwise:
        return piece.winding < 0;
      case CullMode::none:
        break;
    }
    return false;
  }

  // Coverage and depth; take(band) gets each band in which there is something to shade or to note, with its
  // windows in the room() that was asked for last. behind() is called behind each triangle.
  template <typename Room, typename Take, typename Behind>
  void rasterize(Batch& batch, Room room, Take take, Behind behind) {
    counters_.vertices += batch.geometry.shaded_vertices.size();
    counters_.triangles += batch.geometry.triangles.size();
    std::size_t first = 0;
    for (const BatchTriangle& triangle : batch.geometry.triangles) {
      stop_if_asked();
      TriangleWork work;
      work.outcome = triangle.outcome;
      work.new_vertices = triangle.new_vertices;
      work.pieces = 0;
      for (std::size_t piece = first; piece < first + triangle.pieces; ++piece) {
        const raster::TriangleSetup& setup = batch.geometry.setup(piece);
        if (culled(setup, batch.state().cull)) continue;
        ++work.pieces;
        rasterize(batch, piece, setup, work, room, take);
      }
      first += triangle.pieces;
      if (work.pieces == 0 && triangle.pieces != 0) work.outcome = TriangleOutcome::back_facing;
      if (work.outcome == TriangleOutcome::drawn && work.quad_count == 0)
        work.outcome = TriangleOutcome::no_coverage;
      count(work);
      ++batch.draw->triangles;
      if (record_ == Record::nothing) continue;
      batch.part.triangles.push_back(work);
      behind();
    }
  }

  template <typename Room, typename Take>
  void rasterize(Batch& batch, std::size_t piece, const raster::TriangleSetup& setup, TriangleWork& work,
                 Room room, Take take) {
    if (!setup.covers) return;
    DrawInFlight& draw = *batch.draw;
    const bool sampled = record_ != Record::nothing && draw.record.is_sampled(draw.triangles);
    const bool noted = sampled || record_ == Record::everything;
    ClearTiles* const clear_tiles = sampled && draw.clear_tiles ? &*draw.clear_tiles : nullptr;
    if (record_ != Record::nothing) work.tile_count += raster::tiles_touched(setup);
    for (int y = setup.top & ~1; y < setup.bottom; y += raster::kWindow) {
      const Windows windows = room();
      if (clear_tiles != nullptr) clear_tiles->look(setup, y);
      const raster::BandCounts counts = raster::rasterize_band(setup, draw.depth, y, windows);
      counters_.fragments += counts.covered;
      counters_.fragments_passed += counts.passed;
      work.quad_count += counts.quads;
      work.quads_passed += counts.quads_passed;
      if (clear_tiles != nullptr)
        clear_tiles->note(windows.first(counts.windows), static_cast<std::uint32_t>(draw.triangles),
                          batch.part.clear_tiles);
      if (noted ? counts.windows != 0 : draw.bindings.draw.state.color_write && counts.passed != 0)
        take(Band{piece, noted, counts.windows});
    }
  }

  void count(const TriangleWork& work) {
    counters_.quads += work.quad_count;
    counters_.triangles_clipped += work.pieces > 1;
    if (work.outcome == TriangleOutcome::drawn) return;  // nearly every one
    counters_.triangles_without_coverage += work.outcome == TriangleOutcome::no_coverage;
    counters_.triangles_outside += work.outcome == TriangleOutcome::outside_frustum;
    counters_.triangles_behind += work.outcome == TriangleOutcome::behind_near;
    counters_.triangles_not_finite += work.outcome == TriangleOutcome::not_finite;
    counters_.triangles_back_facing += work.outcome == TriangleOutcome::back_facing;
  }

  Record record_;
  RenderCounters& counters_;
  const DrawPipeline::Done* done_ = nullptr;
  std::array<raster::Window, raster::kMaxWindows> windows_;
  std::atomic<int> waiting_ = 0;  // batches whose depth is tested when they are written
};

std::size_t thread_count() {
  using tbb::global_control;
  const auto arena = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return std::min(arena, global_control::active_value(global_control::max_allowed_parallelism));
}

}  // namespace

class DrawPipeline::State {
 public:
  State(const RenderOptions& options, std::uint32_t width, std::uint32_t height, RenderCounters& counters)
      : options_(options),
        indices_(options.vertex_cache_entries),
        workers_([&options, width, height] { return Worker(options, width, height); }),
        stages_(options.record, counters) {}

  void run(Frame& frame, const Next& next, const Done& done) {
    draw_ = nullptr;
    stages_.begin(done);
    const std::size_t threads = thread_count(), batches = threads > 1 ? kBatchesAThread * threads : 1;
    while (batches_.size() < batches) batches_.push_back(std::make_unique<Batch>());
    threads > 1 ? run_in_flight(batches, frame, next) : run_one_by_one(frame, next);
  }

 private:
  // False: no draw is left. Each has a batch at least.
  bool fill(Batch& batch, Frame& frame, const Next& next) {
    if (draw_ == nullptr) {
      std::optional<DrawTask> task = next();
      if (!task) return false;
      draw_ = std::make_shared<DrawInFlight>(std::move(*task), frame, options_.record);
      indices_.begin(draw_->bindings);
    }
    if (batch.draw != draw_) batch.bind(draw_);
    if (!indices_.fill(batch.geometry)) draw_ = nullptr;
    return true;
  }

  void run_one_by_one(Frame& frame, const Next& next) {
    Batch& only = *batches_[0];
    Worker& worker = workers_.local();
    while (fill(only, frame, next)) {
      worker.process(only);
      stages_.test_shade_and_write(only, worker);
    }
  }

  // Several batches at once, each in one stage.
  void run_in_flight(std::size_t batches, Frame& frame, const Next& next) {
    using tbb::filter_mode;
    std::size_t filled = 0;
    const auto fill_next = [&](tbb::flow_control& control) -> Batch* {
      Batch& next_batch = *batches_[filled++ % batches];
      next_batch.take_again();
      if (fill(next_batch, frame, next)) return &next_batch;
      next_batch.hand_back();
      control.stop();
      return nullptr;
    };
    const auto stage = [](filter_mode mode, auto run) {
      return tbb::make_filter<Batch*, Batch*>(mode, [run](Batch* batch) {
        run(*batch);
        return batch;
      });
    };
    tbb::parallel_pipeline(
        batches,
        tbb::make_filter<void, Batch*>(filter_mode::serial_in_order, fill_next) &
            stage(filter_mode::parallel, [&](Batch& batch) { workers_.local().process(batch); }) &
            stage(filter_mode::serial_in_order, [&](Batch& batch) { stages_.test_depth(batch); }) &
            stage(filter_mode::parallel, [&](Batch& batch) { LaterStages::shade(batch, workers_.local()); }) &
            tbb::make_filter<Batch*, void>(filter_mode::serial_in_order, [&](Batch* batch) {
              stages_.write(*batch, workers_.local());
              batch->hand_back();
            }));
  }

  const RenderOptions& options_;
  Indices indices_;
  tbb::enumerable_thread_specific<Worker> workers_;
  LaterStages stages_;
  std::vector<std::unique_ptr<Batch>> batches_;
  std::shared_ptr<DrawInFlight> draw_;  // of which the next batch is filled; null: of the next one
};

DrawPipeline::DrawPipeline(const RenderOptions& options, std::uint32_t width, std::uint32_t height,
                           RenderCounters& counters)
    : state_(std::make_unique<State>(options, width, height, counters)) {}
DrawPipeline::~DrawPipeline() = default;

void DrawPipeline::run(Frame& frame, const Next& next, const Done& done) {
  state_->run(frame, next, done);
}

}  // namespace splatscope
