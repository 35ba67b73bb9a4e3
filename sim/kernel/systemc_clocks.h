#pragma once

#include <span>

#include "sim/kernel/clock_domain.h"

namespace splatscope::sim {

inline constexpr std::size_t kMostDomains = 2;  // core (with the memory), bus

// Runs the domains on the SystemC kernel until none has anything left to do. Each domain is one SC_METHOD,
// which runs its cycles up to the next one at which another domain acts, then sleeps until its own next. An
// exception of a unit ends the run and is thrown from here.
//
// SystemC elaborates once in a process, a study simulates many times: the modules are elaborated on the first
// call and keep running an empty clock; each call lends them the domains of its run. Calls from several
// threads take turns.
void run_on_systemc(std::span<ClockDomain* const> domains);

}  // namespace splatscope::sim
