#pragma once

#include <string>

#include "model/error.h"

namespace splatscope {

// What a test's `run` throws as a UserError; "no error" where it ends.
template <typename Run>
std::string error_of(Run run) {
  try {
    run();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace splatscope
