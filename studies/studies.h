#pragma once

#include "studies/study.h"

namespace splatscope::studies {

// Questions of our own to the simulated machines, by name.
std::span<const Study> own_studies();

}  // namespace splatscope::studies
