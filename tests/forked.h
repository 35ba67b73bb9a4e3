#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "program.h"

// Runs the program in a copy of the test's process: all of it but the loading of its libraries, which takes
// longer than most bad input. A test that uses this starts no thread of the program before.
namespace splatscope::tests {

struct Limits {
  std::optional<rlim_t> cpu_seconds = {};  // of all threads; beyond it a signal ends the program
  std::optional<rlim_t> file_bytes = {};   // of each file that it writes: as good as a small disk
  std::filesystem::path output = {};       // standard output, where it is not kept for the outcome
};

struct Used {
  long peak_kilobytes = 0;  // resident
  double cpu_seconds = 0;
};

class Forked {
 public:
  // Starts it in the given folder.
  Forked(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
         const Limits& limits = {}) {
    if (::pipe(error_) != 0) throw std::runtime_error("pipe failed");
    std::fflush(nullptr);  // or both have a copy of what waits to be printed
    process_ = ::fork();
    if (process_ < 0) throw std::runtime_error("fork failed");
    if (process_ == 0) run(arguments, folder, limits);
    ::close(error_[1]);
  }
  ~Forked() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    ::close(error_[0]);
  }
  Forked(const Forked&) = delete;
  Forked& operator=(const Forked&) = delete;

  // Sent once the program listens: before, it would end the process without a word.
  void signal(int number) const {
    const auto listens = [&] {
      const std::string status = text_of(fmt::format("/proc/{}/status", process_));
      const std::size_t caught = status.find("SigCgt:");
      return caught == std::string::npos ||
             (std::stoull(status.substr(caught + 7), nullptr, 16) >> (number - 1) & 1);
    };
    while (!listens()) ::usleep(1000);
    ::kill(process_, number);
  }

  // Waits for its end.
  Outcome outcome() {
    std::string error;
    char part[4096];
    for (ssize_t size = 0; (size = ::read(error_[0], part, sizeof part)) > 0;)
      error.append(part, static_cast<std::size_t>(size));
    int status = 0;
    rusage usage{};
    ::wait4(process_, &status, 0, &usage);
    process_ = -1;
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    used_ = {usage.ru_maxrss, seconds(usage.ru_utime) + seconds(usage.ru_stime)};
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out()), std::move(error)};
  }
  const Used& used() const { return used_; }  // after outcome()

 private:
  std::filesystem::path out() const { return printed_.path() / "out"; }

  static void limit(int resource, std::optional<rlim_t> value) {
    if (!value) return;
    const rlimit both{*value, *value + (resource == RLIMIT_CPU ? 1 : 0)};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
  }

  // Where it fails, the child says so in the place of what it should do.
  static void redirect(const std::filesystem::path& path, int flags, int descriptor) {
    const int file = ::open(path.c_str(), flags, 0600);
    if (file >= 0 && ::dup2(file, descriptor) >= 0) return;
    std::perror(path.c_str());
    ::_exit(EXIT_FAILURE);
  }

  // An exception that nobody catches ends it here: above are the test's functions, which would go on twice.
  [[noreturn]] void run(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                        const Limits& limits) const noexcept {
    std::filesystem::current_path(folder);
    const auto output = limits.output.empty() ? out() : limits.output;
    ::dup2(error_[1], STDERR_FILENO);
    ::close(error_[1]);
    redirect(output, O_WRONLY | O_CREAT, STDOUT_FILENO);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);  // as a terminal: each line can fail
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    limit(RLIMIT_CORE, rlim_t{0});
    limit(RLIMIT_CPU, limits.cpu_seconds);
    limit(RLIMIT_FSIZE, limits.file_bytes);
    std::vector<const char*> argv{"splatscope"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    const int status = app::run_command_line(static_cast<int>(argv.size()), argv.data());
    std::fflush(nullptr);
    ::_exit(status);  // libraries would wait for threads of theirs that were not copied
  }

  ScratchFolder printed_;
  int error_[2] = {-1, -1};  // a pipe: no limit of file sizes cuts what is said
  pid_t process_ = -1;
  Used used_;
};

}  // namespace splatscope::tests
