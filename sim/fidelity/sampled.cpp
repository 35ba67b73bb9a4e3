#include "sim/fidelity/sampled.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>
#include <utility>

#include "model/error.h"
#include "sim/fidelity/stretches.h"
#include "sim/fidelity/thinning.h"

namespace splatscope::sim {
namespace {

constexpr double kDistance = 24;  // stretches to a sample
constexpr double kFewest = 18;    // samples of a population, where one unit explains what they take, and
constexpr double kMany = 80;      // where none does
// A population of fewer stretches is simulated whole, and so is one of which half would run for its samples.
constexpr double kSmallest = 120;
constexpr std::size_t kTail = 2;  // stretches, at least, at the end of a draw
// How many times what fills the queues the start of a draw is: where the units before and behind a queue are
// about as fast, it fills by their difference alone, and so late.
constexpr std::size_t kFillings = 6;
constexpr std::size_t kShortest = 32;  // stretches between start and end, or a draw is simulated whole
constexpr double kCutBias = 0.004;

// Stretches that fill what lies behind primitive assembly, whose clock the samples go by: before that, it
// runs ahead of the units that keep it waiting later. Two at the least, for what else has a memory.
std::size_t stretches_to_fill(const Machine& machine) {
  constexpr int kQuads = 4;  // of a triangle, about
  const int triangles = machine.primitive.queue + machine.setup.queue;
  const int quads = machine.raster.queue + machine.depth.pending + machine.depth.queue +
                    machine.texture.pending + machine.texture.queue + machine.pixel.queue +
                    machine.blend.pending;
  const auto held = static_cast<std::size_t>(triangles + quads / kQuads);
  return std::max<std::size_t>(2, (held + kStretch - 1) / kStretch);
}

// Stretches of the draws of a frame that have their state in common. Frames are apart: what draws of one take
// says little of another, as in progressive frames from coarse to fine.
struct Population {
  std::size_t stretches = 0;  // of all draws, one behind the other
  std::size_t begun = 0;      // of the draws so far
  double distance = 0;        // stretches to a part, of which one is a sample; 0: none are taken
  double parts = 0;           // before the next sample
  std::size_t sample = 0;     // the next one
  double expected = 0;        // clocks of all
  double contested = 0;       // of these, where another stage is about as slow as the slowest one
  std::vector<double> sampled_expected, sampled_cycles;
  std::vector<Books> sampled_books;  // of all samples together, by unit

  bool is_sampled() const { return distance > 0; }
  void choose_next(std::mt19937_64& random) {
    const double in_part = static_cast<double>(random() >> 11) * 0x1p-53;
    sample = static_cast<std::size_t>(distance * (parts + in_part));
    ++parts;
  }
  // Cycles of all stretches for one of the sampled.
  double weight() const {
    double sum = 0;
    for (const double clocks : sampled_expected) sum += clocks;
    return expected / sum;
  }
  double estimate() const {
    double sum = 0;
    for (const double cycles : sampled_cycles) sum += cycles;
    return sum * weight();
  }
  // Whether the throughput of one stage is what the stretches take: then what was not sampled is as what was.
  bool is_explained() const {
    constexpr double kMostContested = 0.02, kMostOff = 0.03;
    return contested <= kMostContested * expected && std::abs(estimate() / expected - 1) <= kMostOff;
  }
  // Variance of estimate(): of a ratio, from the residuals of the samples. Neighbours are compared: where a
  // draw changes slowly on its way, systematic samples scatter less than random ones (Wolter 2007, section
  // 8.2).
  double variance() const {
    const double n = static_cast<double>(sampled_cycles.size());
    const double ratio = estimate() / expected;
    const auto residual = [&](std::size_t i) { return sampled_cycles[i] - ratio * sampled_expected[i]; };
    double squares = 0;
    for (std::size_t i = 1; i < sampled_cycles.size(); ++i)
      squares += (residual(i) - residual(i - 1)) * (residual(i) - residual(i - 1)) / 2;
    const double left_out = 1 - n / static_cast<double>(stretches);
    return weight() * weight() * left_out * n * squares / (n - 1);
  }
};

using State =
    std::tuple<std::size_t, std::uint32_t, std::optional<std::uint32_t>, std::optional<std::uint32_t>,
               std::uint32_t, std::optional<std::uint32_t>, bool, bool, bool, bool>;
State state_of(std::size_t frame, const Draw& draw) {
  const DrawState& s = draw.state;
  return {frame,       draw.vertex_program, draw.pixel_program, draw.texture,  draw.target,
          draw.source, s.depth_test,        s.depth_write,      s.color_write, s.blend};
}

// 97.5 % quantile of Student's t (Abramowitz and Stegun 26.7.5) for a variance from the n - 1 differences of
// neighbours, which overlap and so have fewer degrees of freedom (von Neumann et al. 1941).
double student_t(double n) {
  const double freedom = 2 * (n - 1) * (n - 1) / (3 * n - 4);
  const double z = 1.959964;
  return z + (z * z * z + z) / (4 * freedom) +
         (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
}

// What the time counts from a mark of a thinned draw to the next one.
enum class Role : std::uint8_t {
  exact,    // itself: start and end of a draw
  warming,  // nothing: the machine comes from another place of the draw
  sample    // a sample of what was left out
};

// From a mark to the next one, in the run of the thinned draws.
struct Interval {
  Role role = Role::exact;
  Population* population = nullptr;
  std::size_t stretch = 0;  // of a sample, in its draw
  double expected = 0;      // clocks of it
};

class Sampler {
 public:
  Sampler(const Trace& trace, const PartSource& next_part, const Machine& machine, const Sampling& sampling,
          const std::function<void(double)>& progress)
      : trace_(trace),
        progress_(progress),
        filling_(stretches_to_fill(machine)),
        start_(kFillings * filling_),
        layout_(lay_out(trace, machine)),
        random_(sampling.seed) {
    PreparedDraws draws = prepare_draws(trace, machine, layout_);
    stretches_.emplace(trace, machine, layout_, draws);
    plan(sampling);
    machine_ = build_machine(trace, std::move(draws), layout_, machine, Scheduler::skip_ahead);
    parts_.emplace(next_part, machine_->of_draws);
    machine_->command->on_draw([this](std::uint32_t draw) { begin(draw); });
    intervals_.emplace_back();
  }

  Result result() {
    machine_->assembly->on_mark([this](Cycle now) { note(now); });
    note(0);
    machine_->run();
    note(machine_->cycles());
    end_draw();
    if (notes_.size() != intervals_.size() + 1) throw_marks_differ();
    weigh();
    Result result;
    result.cycles = static_cast<Cycle>(std::llround(estimated(machine_->cycles())));
    result.seconds = seconds_of(result.cycles, machine_->core.time(1));
    for (const Cycle end : machine_->host->command_ends())
      result.command_ends.push_back(static_cast<Cycle>(std::llround(estimated(machine_->core_cycle(end)))));
    result.frame_cycles = cycles_of_frames(trace_, result);
    const std::size_t frames = result.frame_cycles.size();
    result.cycles_plus_minus = plus_minus(0, frames);
    for (std::size_t i = 0; i < frames; ++i) result.frame_plus_minus.push_back(plus_minus(i, i + 1));
    add_books(result);
    result.units_left_out = left_out(trace_, machine_->built, machine_->jobs);
    return result;
  }

  // Of the samples of a second run, by frame; empty: the first one is enough.
  std::vector<double> needed_density(const Result& first) const {
    constexpr double kMargin = 1.2;  // the scatter is known from few samples
    std::vector<double> density(first.frame_cycles.size(), 1);
    for (std::size_t i = 0; i < density.size(); ++i) {
      const auto cycles = static_cast<double>(first.frame_cycles[i]);
      if (first.frame_plus_minus[i] <= kPrecision * cycles) continue;
      const double scatter = first.frame_plus_minus[i] / cycles - kCutBias;
      density[i] = kMargin * std::pow(scatter / (kPrecision - kCutBias), 2);
    }
    for (const auto& [state, population] : populations_) {
      const std::size_t its_frame = std::get<0>(state);
      if (!population.is_sampled() || population.is_explained() || its_frame >= density.size()) continue;
      const auto samples = static_cast<double>(population.sampled_cycles.size());
      density[its_frame] = std::max(density[its_frame], kMany / samples);
    }
    if (std::ranges::all_of(density, [](double each) { return each <= 1; })) density.clear();
    return density;
  }

 private:
  // Stretches of a draw between its start and its end.
  std::size_t between(std::size_t triangles) const {
    const std::size_t stretches = triangles / kStretch;
    return stretches < start_ + kTail + kShortest ? 0 : stretches - start_ - kTail;
  }

  // What is sampled, and how often.
  void plan(const Sampling& sampling) {
    std::size_t frame = 0;
    for (const Command& command : trace_.commands) {
      if (std::holds_alternative<Present>(command)) ++frame;
      const Draw* draw = std::get_if<Draw>(&command);
      if (draw == nullptr) continue;
      Population& population = populations_[state_of(frame, *draw)];
      population.stretches += between(draw->index_count / 3);
      population_of_.push_back(&population);
    }
    for (auto& [state, population] : populations_) {
      const auto stretches = static_cast<double>(population.stretches);
      const std::size_t its_frame = std::get<0>(state);
      const double density = its_frame < sampling.density.size() ? sampling.density[its_frame] : 1;
      const double samples = density * std::max(kFewest, stretches / kDistance);
      const double run = samples * (static_cast<double>(filling_) + 0.5);  // as thin() has it, on average
      if (stretches < std::max(kSmallest, 2 * run)) continue;
      population.distance = stretches / samples;
      population.choose_next(random_);
    }
  }

  void begin(std::uint32_t draw) {
    if (progress_) progress_(static_cast<double>(draw) / static_cast<double>(machine_->jobs.size()));
    end_draw();
    DrawJob& job = machine_->jobs[draw];
    for (; next_command_ < job.command; ++next_command_)
      if (std::holds_alternative<Clear>(trace_.commands[next_command_])) stretches_->clear();
    Population& population = *population_of_[draw];
    if (!population.is_sampled()) return parts_->begin(job, {}, nullptr);
    sampled_ = &population;
    stretches_->begin(job);
    parts_->begin(job, thin(job), &*stretches_);
  }

  // Which triangles of a draw run, and an interval of each span of them.
  std::vector<Span> thin(DrawJob& job) {
    const std::size_t triangles = job.draw->index_count / 3;
    between_ = between(triangles);
    std::vector<Span> spans;
    std::size_t kept = 0, thinned = 0;  // where the last span ends in the draw, and in what is kept
    marks_.clear();
    const auto keep = [&](std::size_t from, std::size_t to, Role role, std::size_t stretch = 0) {
      from = std::max(from, kept);
      to = std::min(to, triangles);
      if (from >= to) return;  // the mark of a span without triangles would never be met
      kept = to;
      spans.emplace_back(from, to);
      marks_.push_back(static_cast<std::uint32_t>(thinned));
      thinned += to - from;
      intervals_.push_back({role, sampled_, stretch, 0});
    };
    // Up to a stretch more, at random: else all samples could begin at the same beat of the vertex threads.
    // Of pairs of triangles: half a splat would change which vertices go together.
    const auto warm = [&](std::size_t stretch) {
      const std::size_t more = 2 * (random_() % (kStretch / 2));
      keep((stretch - filling_) * kStretch + more, stretch * kStretch, Role::warming);
    };
    first_interval_ = intervals_.size();
    keep(0, start_ * kStretch, Role::exact);
    const std::size_t end = start_ + between_;
    for (; sampled_->sample < sampled_->begun + between_; sampled_->choose_next(random_)) {
      const std::size_t sample = start_ + sampled_->sample - sampled_->begun;
      warm(sample);
      keep(sample * kStretch, (sample + 1) * kStretch, Role::sample, sample);
    }
    sampled_->begun += between_;
    warm(end);
    keep(end * kStretch, triangles, Role::exact);
    job.marks = marks_;
    return spans;
  }

  // What Stretches expect of the samples of the draw before, and of all that they stand for.
  void end_draw() {
    if (sampled_ == nullptr) return;
    const std::vector<Clocks> clocks = stretches_->clocks();
    const auto expected = [&](std::size_t stretch) { return *std::ranges::max_element(clocks[stretch]); };
    for (const Clocks& stages : std::span(clocks).subspan(start_, between_)) {
      constexpr double kNear = 0.7;
      const double slowest = *std::ranges::max_element(stages);
      sampled_->expected += slowest;
      if (std::ranges::count_if(stages, [&](double stage) { return stage > kNear * slowest; }) > 1)
        sampled_->contested += slowest;
    }
    for (Interval& interval : std::span(intervals_).subspan(first_interval_))
      if (interval.role == Role::sample) interval.expected = expected(interval.stretch);
    sampled_ = nullptr;
  }

  [[noreturn]] static void throw_marks_differ() {
    throw ModelError("sampling: a mark of a thinned draw was not met, or met twice");
  }

  // The end of one interval, and the start of the next.
  void note(Cycle now) {
    std::vector<Books> books;  // by unit
    for (const ClockDomain* domain : {&machine_->core, &machine_->bus}) {
      for (std::size_t place = 0; place < domain->units().size(); ++place)
        books.push_back(domain->closed_books(place, now));
    }
    if (notes_.size() > intervals_.size()) throw_marks_differ();
    if (!notes_.empty()) sum_books(intervals_[notes_.size() - 1], books);
    books_ = std::move(books);
    notes_.push_back(now);
  }

  void sum_books(const Interval& interval, std::span<const Books> books) {
    if (interval.role == Role::warming) return;
    std::vector<Books>& sum =
        interval.role == Role::exact ? exact_books_ : interval.population->sampled_books;
    sum.resize(books.size());
    for (std::size_t unit = 0; unit < books.size(); ++unit)
      for (std::size_t cause = 0; cause < books[unit].cycles.size(); ++cause)
        sum[unit].cycles[cause] += books[unit].cycles[cause] - books_[unit].cycles[cause];
  }

  // How much a cycle of each interval counts.
  void weigh() {
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      if (intervals_[i].role != Role::sample) continue;
      intervals_[i].population->sampled_cycles.push_back(static_cast<double>(notes_[i + 1] - notes_[i]));
      intervals_[i].population->sampled_expected.push_back(intervals_[i].expected);
    }
    for (const Interval& interval : intervals_) {
      weights_.push_back(interval.role == Role::exact     ? 1
                         : interval.role == Role::warming ? 0
                                                          : interval.population->weight());
    }
  }

  // The cycle of the whole trace for one of the run.
  double estimated(Cycle cycle) const {
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size() && notes_[i] < cycle; ++i)
      sum += weights_[i] * static_cast<double>(std::min(cycle, notes_[i + 1]) - notes_[i]);
    return sum;
  }

  // Of frames first to last - 1 together.
  double plus_minus(std::size_t first, std::size_t last) const {
    double variance = 0, estimate = 0;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const auto& [state, population] : populations_) {
      if (!population.is_sampled() || std::get<0>(state) < first || std::get<0>(state) >= last) continue;
      variance += population.variance();
      estimate += population.estimate();
      fewest = std::min(fewest, population.sampled_cycles.size());
    }
    return student_t(static_cast<double>(fewest)) * std::sqrt(variance) + kCutBias * estimate;
  }

  // Rounded so that they still add up.
  void add_books(Result& result) const {
    std::vector<std::pair<double, const std::vector<Books>*>> weighed{{1, &exact_books_}};
    for (const auto& [state, population] : populations_)
      if (population.is_sampled()) weighed.emplace_back(population.weight(), &population.sampled_books);
    std::size_t number = 0;
    for (const ClockDomain* domain : {&machine_->core, &machine_->bus}) {
      for (const Unit* unit : domain->units()) {
        Books books;
        double sum = 0;
        Cycle rounded = 0;
        for (std::size_t cause = 0; cause < books.cycles.size(); ++cause) {
          for (const auto& [weight, of_units] : weighed)
            sum += weight * static_cast<double>((*of_units)[number].cycles[cause]);
          books.cycles[cause] = static_cast<Cycle>(std::llround(sum)) - rounded;
          rounded += books.cycles[cause];
        }
        result.units.push_back(named_books(*machine_, *unit, books));
        ++number;
      }
    }
  }

  const Trace& trace_;
  const std::function<void(double)>& progress_;
  const std::size_t filling_;  // stretches that run before each sample
  const std::size_t start_;    // and at the start of a draw
  MemoryLayout layout_;
  std::optional<Stretches> stretches_;
  std::size_t next_command_ = 0;  // that `stretches_` are to see
  std::mt19937_64 random_;
  std::map<State, Population> populations_;
  std::vector<Population*> population_of_;  // each draw
  std::unique_ptr<SimulatedMachine> machine_;
  std::optional<ThinParts> parts_;
  // Of the draw that runs, if it is sampled.
  Population* sampled_ = nullptr;
  std::size_t between_ = 0, first_interval_ = 0;
  std::vector<std::uint32_t> marks_;
  std::vector<Interval> intervals_;  // of the run; interval i begins at notes_[i]
  std::vector<Cycle> notes_;
  std::vector<Books> books_, exact_books_;  // at the last note; of all exact intervals together
  std::vector<double> weights_;
};

}  // namespace

Result estimate_sampled(const Trace& trace, std::span<const DrawWork> work, const Machine& machine,
                        std::uint64_t seed) {
  expect_work_of_each_draw(trace, work);
  const auto run = [&](const std::vector<double>& density) {
    auto next = work.begin();
    return estimate_sampled_beside(
        trace,
        [&]() -> const DrawWork& {
          if (next == work.end()) throw ModelError("the work records hold fewer triangles than the draws");
          return *next++;
        },
        machine, {seed, density});
  };
  SampledRun first = run({});
  return first.density.empty() ? std::move(first.result) : run(first.density).result;
}

SampledRun estimate_sampled_beside(const Trace& trace, const PartSource& next_part, const Machine& machine,
                                   const Sampling& sampling, const std::function<void(double)>& progress) {
  Sampler sampler(trace, next_part, machine, sampling, progress);
  SampledRun run{sampler.result(), {}};
  if (sampling.density.empty()) run.density = sampler.needed_density(run.result);
  return run;
}

}  // namespace splatscope::sim
