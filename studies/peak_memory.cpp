#include "studies/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace splatscope::studies {

bool restart_peak_memory() {
  // What a thread frees at the end of its own heap stays there (glibc), and ever larger pieces do as some are
  // freed, unless they are mapped for themselves: so then would the memory of one run be missing in the next.
  constexpr int kMapped = 128 * 1024;
  mallopt(M_MMAP_THRESHOLD, kMapped);
  malloc_trim(0);
  std::ofstream file("/proc/self/clear_refs");
  file << 5;  // proc(5): reset the peak resident set size
  return static_cast<bool>(file.flush());
}

double peak_megabytes() {
  std::ifstream file("/proc/self/status");
  for (std::string key; file >> key; file.ignore(256, '\n')) {
    double kibibytes = 0;
    if (key == "VmHWM:" && file >> kibibytes) return kibibytes * 1024 / 1e6;
  }
  return 0;
}

}  // namespace splatscope::studies
