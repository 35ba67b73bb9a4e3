#pragma once

#include <utility>
#include <vector>

#include "sim/draw_jobs.h"
#include "sim/kernel/channel.h"
#include "sim/units/draw_unit.h"
#include "sim/units/memory/memory_port.h"

// What the tests of units put around them: sources, sinks, a memory of fixed latency. Units are tested in a
// ClockDomain alone, without the SystemC kernel.
namespace splatscope::sim::testing {

inline constexpr Femtoseconds kPeriod = 1'000'000;

template <class T>
using Timed = std::vector<std::pair<Cycle, T>>;

// Pushes each item as soon as its cycle has come and there is room, one a cycle.
template <class T>
class Source final : public Unit {
 public:
  explicit Source(Timed<T> items) : Unit("source"), items_(std::move(items)) {}
  void connect(Channel<T>& out) { out_ = &out; }

  Step advance(Cycle now) override {
    if (next_ == items_.size()) return idle();
    if (items_[next_].first > now) return idle(items_[next_].first);
    if (!out_->can_push(now)) return blocked(out_->consumer(), out_->next_free());
    out_->push(now, items_[next_++].second);
    return busy(now + 1);
  }

 private:
  Timed<T> items_;
  std::size_t next_ = 0;
  Channel<T>* out_ = nullptr;
};

// Takes every item from cycle `from` on, and notes when.
template <class T>
class Sink final : public Unit {
 public:
  explicit Sink(Cycle from = 0) : Unit("sink"), from_(from) {}
  void connect(Channel<T>& in) { in_ = &in; }
  const Timed<T>& taken() const { return taken_; }

  Step advance(Cycle now) override {
    if (now < from_) return idle(from_);
    if (!in_->can_pop(now)) return starved(in_->next_visible());
    while (in_->can_pop(now)) taken_.emplace_back(now, in_->pop(now));
    return busy(now + 1);
  }

 private:
  Cycle from_;
  Channel<T>* in_ = nullptr;
  Timed<T> taken_;
};

// Takes one request a cycle and answers it `latency` cycles later; notes what was asked for and when.
class FixedMemory final : public Unit {
 public:
  explicit FixedMemory(Cycle latency) : Unit("memory"), latency_(latency) {}
  void connect(MemoryPort& port, Channel<MemoryRequest>& requests) {
    clients_.emplace_back(&port, &requests);
  }
  const Timed<MemoryRequest>& requests() const { return requests_; }

  Step advance(Cycle now) override {
    Cycle next = kNever;
    for (const auto& [port, requests] : clients_) {
      if (requests->can_pop(now)) {
        const MemoryRequest request = requests->pop(now);
        requests_.emplace_back(now, request);
        if (request.write) {
          port->written(now + latency_);
        } else {
          port->answer(request.slot, now + latency_);
        }
      }
      next = std::min(next, requests->next_visible());
    }
    return idle(next);
  }

 private:
  Cycle latency_;
  std::vector<std::pair<MemoryPort*, Channel<MemoryRequest>*>> clients_;
  Timed<MemoryRequest> requests_;
};

// Stands in for the command processor: notes when a command is done.
class Waiter final : public Unit {
 public:
  explicit Waiter(const Completion& completion) : Unit("waiter"), completion_(completion) {}
  Cycle done_at() const { return done_at_; }

  Step advance(Cycle now) override {
    if (completion_.done_at() == now) done_at_ = now;
    return idle();
  }

 private:
  const Completion& completion_;
  Cycle done_at_ = kNever;
};

// A clock domain with its units, and the completion that draw units report to.
class Bench {
 public:
  explicit Bench(Scheduler scheduler = Scheduler::skip_ahead)
      : domain_("bench", kPeriod, kPeriod, scheduler), waiter_(completion_) {
    completion_.set_waiter(waiter_);
    add(waiter_);
  }
  void add(Unit& unit) { domain_.add(unit, next_number_++); }
  void run() { domain_.run(kNever - 1); }
  // As the command processor would before cycle 0.
  void begin(const DrawJob& job, std::initializer_list<DrawUnit*> units) {
    std::uint32_t working = 0;
    for (DrawUnit* unit : units) working += unit->begin(job);
    completion_.start(0, working);
  }

  ClockDomain& domain() { return domain_; }
  Completion& completion() { return completion_; }
  Cycle done_at() const { return waiter_.done_at(); }
  Books books(const Unit& unit, Cycle end) const {
    for (std::size_t place = 0; place < domain_.units().size(); ++place) {
      if (domain_.units()[place] == &unit) return domain_.closed_books(place, end);
    }
    return {};
  }

 private:
  ClockDomain domain_;
  Completion completion_;
  Waiter waiter_;
  std::uint32_t next_number_ = 0;
};

// A port of `client` to one memory of fixed latency.
struct TestMemory {
  TestMemory(Bench& bench, Unit& client, Cycle latency, int queue = 64)
      : memory(latency),
        port(client, 4096),
        requests((bench.add(memory), "requests"), client, memory, queue) {
    memory.connect(port, requests);
    port.connect({&requests}, 64);
  }

  FixedMemory memory;
  MemoryPort port;
  Channel<MemoryRequest> requests;
};

// When so many requests of each of two clients are answered that begin at once.
template <class Client, class Server>
std::vector<std::pair<Cycle, Cycle>> answers_of_two(Client& first, Client& second, Server& server,
                                                    std::size_t requests) {
  Bench bench;
  for (Unit* unit : {static_cast<Unit*>(&first), static_cast<Unit*>(&second), static_cast<Unit*>(&server)})
    bench.add(*unit);
  Channel<MemoryRequest> of_first("first", first, server, 16), of_second("second", second, server, 16);
  server.connect(first.port, of_first);
  server.connect(second.port, of_second);
  first.port.connect({&of_first}, 64);
  second.port.connect({&of_second}, 64);
  bench.run();
  std::vector<std::pair<Cycle, Cycle>> answers;
  for (std::size_t i = 0; i < requests; ++i) {
    answers.emplace_back(first.port.oldest_ready(), second.port.oldest_ready());
    first.port.release_oldest();
    second.port.release_oldest();
  }
  return answers;
}

// A draw of quads of one triangle each; blocks and masks are set by the test.
struct TestDraw {
  Draw draw;
  DrawWork work;
  DrawJob job;

  // Shows it to the units, as for a trace.
  const DrawJob& prepare() {
    job.draw = &draw;
    job.textured = binds_texture(draw);
    show_all(job, work);
    job.counts.colored_quads = 0;
    for (const QuadWork& quad : work.quads) job.counts.colored_quads += is_colored(job, quad);
    return job;
  }
  void add_quad(int x, int y, std::vector<std::uint32_t> blocks = {}, int passed = 0xf) {
    QuadWork quad;
    quad.x = static_cast<std::uint16_t>(x);
    quad.y = static_cast<std::uint16_t>(y);
    quad.covered = 0xf;
    quad.passed = static_cast<std::uint8_t>(passed);
    quad.texel_block_count = static_cast<std::uint8_t>(blocks.size());
    work.quads.push_back(quad);
    work.texel_blocks.insert(work.texel_blocks.end(), blocks.begin(), blocks.end());
  }
  // The numbers of all of them, at once.
  Timed<std::uint32_t> quads() const {
    Timed<std::uint32_t> items;
    for (std::uint32_t i = 0; i < work.quads.size(); ++i) items.emplace_back(0, i);
    return items;
  }
  void add_triangle(int new_vertices, int quads, int tiles, int pieces = 1) {
    TriangleWork triangle;
    triangle.new_vertices = static_cast<std::uint8_t>(new_vertices);
    triangle.quad_count = static_cast<std::uint32_t>(quads);
    triangle.tile_count = static_cast<std::uint32_t>(tiles);
    triangle.pieces = static_cast<std::uint8_t>(pieces);
    if (pieces == 0) triangle.outcome = TriangleOutcome::outside_frustum;
    work.triangles.push_back(triangle);
  }
};

}  // namespace splatscope::sim::testing
