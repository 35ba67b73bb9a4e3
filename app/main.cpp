#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "app/command_line.h"
#include "model/stop.h"

int main(int argc, char** argv) {
  const int status = splatscope::app::run_command_line(argc, argv);
  if (splatscope::stop_signal != 0) {  // work may have been left behind (model/run_apart.h)
    std::cout.flush();
    std::fflush(stdout);
    std::_Exit(status);
  }
  return status;
}
