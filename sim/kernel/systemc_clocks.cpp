#include "sim/kernel/systemc_clocks.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <systemc>
#include <vector>

#include "model/error.h"
#include "model/stop.h"

// The library's own main() would call it; splatscope's programs have their own, so it is never reached.
int sc_main(int, char*[]) {
  return 1;
}

namespace splatscope::sim {
namespace {

sc_core::sc_time femtoseconds(Femtoseconds time) {
  return sc_core::sc_time::from_value(time);
}

class Run;

// One clock domain: what the kernel knows of it.
class DomainProcess : public sc_core::sc_module {
 public:
  explicit DomainProcess(const sc_core::sc_module_name& name) : sc_core::sc_module(name) {
    SC_HAS_PROCESS(DomainProcess);
    SC_METHOD(step);
    sensitive << due_;
    dont_initialize();
  }

  void lend(ClockDomain* domain, Run* run) {
    domain_ = domain;
    run_ = run;
    due_.cancel();
    due_at_ = kNever;
  }
  ClockDomain* domain() const { return domain_; }
  // Asks the kernel for a step at the domain's next cycle, if it has one.
  void notify(Femtoseconds start);

 private:
  void step();

  ClockDomain* domain_ = nullptr;
  Run* run_ = nullptr;
  sc_core::sc_event due_;
  Femtoseconds due_at_ = kNever;  // what due_ is notified for, since the start of the run
};

// The modules, elaborated once, and the run that has them now.
class Run {
 public:
  Run() {
    sc_core::sc_set_time_resolution(1, sc_core::SC_FS);
    static constexpr const char* kNames[kMostDomains] = {"domain_0", "domain_1"};
    for (const char* name : kNames) processes_.push_back(std::make_unique<DomainProcess>(name));
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
  }

  void operator()(std::span<ClockDomain* const> domains) {
    if (domains.size() > kMostDomains) throw ModelError("more clock domains than processes");
    failure_ = nullptr;
    domains_ = domains;
    start_ = sc_core::sc_time_stamp().value();
    if (start_ > std::numeric_limits<Femtoseconds>::max() - kMostTime) return run_without_kernel();
    for (std::size_t i = 0; i < kMostDomains; ++i) {
      processes_[i]->lend(i < domains.size() ? domains[i] : nullptr, this);
    }
    notify_all();
    if (sc_core::sc_pending_activity()) sc_core::sc_start();
    for (const auto& process : processes_) process->lend(nullptr, nullptr);
    if (failure_) std::rethrow_exception(failure_);
  }

  void step(ClockDomain& domain) {
    if (failure_) return;
    try {
      stop_if_asked();
      domain.run(horizon(domain));
    } catch (...) {  // SystemC would turn it into a report and stop for good
      failure_ = std::current_exception();
      return;
    }
    notify_all();
  }

 private:
  // Cycles that a domain runs at most before the program looks whether it is asked to stop: milliseconds.
  static constexpr Cycle kMostAtOnce = 1 << 16;

  // SystemC's time goes on from run to run, and is used up when they have taken minutes of the machine's
  // time. What it does is to call the domain that is due first.
  void run_without_kernel() const {
    while (!domains_.empty()) {
      ClockDomain& first = **std::ranges::min_element(domains_, {}, &ClockDomain::next_time);
      if (first.next_time() == kNever) return;
      stop_if_asked();
      first.run(horizon(first));
    }
  }

  // The last cycle that `domain` may run to: the others cannot send it anything before their own next cycle.
  Cycle horizon(const ClockDomain& domain) const {
    Femtoseconds earliest = kNever;
    for (const ClockDomain* other : domains_)
      if (other != &domain) earliest = std::min(earliest, other->next_time());
    const Cycle last = earliest == kNever ? kNever - 1 : domain.first_after(earliest) - 1;
    return std::min(last, domain.next_visited() + kMostAtOnce);
  }

  void notify_all() {
    for (const auto& process : processes_) process->notify(start_);
  }

  std::vector<std::unique_ptr<DomainProcess>> processes_;
  std::span<ClockDomain* const> domains_;  // of this run
  Femtoseconds start_ = 0;                 // SystemC's time at its start
  std::exception_ptr failure_;
};

void DomainProcess::notify(Femtoseconds start) {
  if (!domain_) return;
  const Femtoseconds next = domain_->next_time();
  if (next >= due_at_) return;
  due_at_ = next;
  const Femtoseconds now = sc_core::sc_time_stamp().value();
  const Femtoseconds at = start + next;
  // A domain that ran ahead may wake the other one in what is SystemC's present: then it is due at once.
  due_.notify(femtoseconds(at > now ? at - now : 0));
}

void DomainProcess::step() {
  due_at_ = kNever;
  run_->step(*domain_);
}

}  // namespace

void run_on_systemc(std::span<ClockDomain* const> domains) {
  static std::mutex turn;
  static Run run;  // SystemC's one simulation context makes this one object of the process
  const std::lock_guard lock(turn);
  run(domains);
}

}  // namespace splatscope::sim
