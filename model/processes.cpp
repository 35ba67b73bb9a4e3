#include "model/processes.h"

#include <oneapi/tbb/global_control.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "model/error.h"
#include "model/stop.h"

namespace splatscope {
namespace {

enum class Kind : std::uint8_t { answer, failure, user_error };

// Before each text on the pipe.
struct Head {
  std::uint64_t number = 0;
  std::uint64_t size = 0;
  Kind kind = Kind::answer;
};

void write_all(int file, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(file, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ::_exit(1);  // nobody listens any more
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

// False at the end.
bool read_all(int file, void* data, std::size_t size) {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(file, bytes, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void say(int file, std::size_t number, const std::string& text, Kind kind) {
  const Head head{number, text.size(), kind};
  write_all(file, &head, sizeof head);
  write_all(file, text.data(), text.size());
}

[[noreturn]] void fail(const std::string& text, Kind kind) {
  if (kind != Kind::user_error) throw std::runtime_error(text);
  const std::size_t colon = text.find(": ");  // as every user's error has it, behind the file and its line
  if (colon == std::string::npos) throw std::runtime_error(text);
  throw UserError(text.substr(0, colon), 0, text.substr(colon + 2));
}

// A child has none but the thread that forked it: no other may hold a lock of oneTBB then, which in the child
// nobody would give back, and oneTBB must not believe in its threads there.
void end_worker_threads() {
  oneapi::tbb::task_scheduler_handle scheduler{oneapi::tbb::attach{}};
  oneapi::tbb::finalize(scheduler, std::nothrow);
}

// What a child does: every `step`-th task. An exception that nobody catches ends it here: above are the
// parent's functions, which would go on twice.
[[noreturn]] void work(int file, std::size_t first, std::size_t step, std::size_t count,
                       const std::function<std::string(std::size_t)>& task) noexcept {
  using Control = oneapi::tbb::global_control;
  const Control one_thread(Control::max_allowed_parallelism, 1);  // the other processes have the other cores
  for (std::size_t number = first; number < count; number += step) {
    try {
      say(file, number, task(number), Kind::answer);
    } catch (const Interrupted&) {
      ::_exit(1);  // asked alone: the parent says that a process ended early
    } catch (const UserError& error) {
      say(file, number, error.what(), Kind::user_error);
    } catch (const std::exception& error) {
      say(file, number, error.what(), Kind::failure);
    }
  }
  ::_exit(0);
}

class Child {
 public:
  Child(std::size_t first, std::size_t step, std::size_t count,
        const std::function<std::string(std::size_t)>& task) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    process_ = ::fork();
    if (process_ < 0) {
      const int error = errno;
      ::close(ends[0]);
      ::close(ends[1]);
      throw std::system_error(error, std::generic_category(), "fork");
    }
    if (process_ == 0) {
      ::close(ends[0]);
      work(ends[1], first, step, count, task);
    }
    ::close(ends[1]);
    file_ = ends[0];
  }
  // One whose answers are no longer wanted is ended: it has nothing of its own to put in order.
  ~Child() {
    ::close(file_);
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int file() const { return file_; }

 private:
  pid_t process_ = -1;
  int file_ = -1;
};

}  // namespace

std::vector<std::string> in_processes(std::size_t count, std::size_t processes,
                                      const std::function<std::string(std::size_t)>& task,
                                      const std::function<void(std::size_t)>& done) {
  std::fflush(nullptr);  // or each child has a copy of what waits to be printed
  const std::size_t children_count = std::clamp<std::size_t>(processes, 1, std::max<std::size_t>(count, 1));
  end_worker_threads();
  std::vector<std::unique_ptr<Child>> children;
  for (std::size_t i = 0; i < children_count; ++i)
    children.push_back(std::make_unique<Child>(i, children_count, count, task));
  std::vector<pollfd> open;
  for (const auto& child : children) open.push_back({child->file(), POLLIN, 0});
  std::vector<std::string> answers(count);
  std::size_t answered = 0;
  while (!open.empty()) {
    constexpr int kMilliseconds = 100;  // until it looks whether it is asked to stop
    stop_if_asked();
    const int ready = ::poll(open.data(), open.size(), kMilliseconds);
    if (ready < 0 && errno == EINTR) continue;  // what `revents` holds then is of before
    if (ready < 0) throw std::system_error(errno, std::generic_category(), "poll");
    for (std::size_t i = open.size(); i-- > 0;) {
      if (open[i].revents == 0) continue;
      Head head;
      std::string text;
      if (read_all(open[i].fd, &head, sizeof head)) {
        text.resize(head.size);
        if (read_all(open[i].fd, text.data(), text.size())) {
          if (head.kind != Kind::answer) fail(text, head.kind);
          answers[head.number] = std::move(text);
          ++answered;
          if (done) done(answered);
          continue;
        }
      }
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  stop_if_asked();
  if (answered != count) throw std::runtime_error("a process ended early");
  return answers;
}

}  // namespace splatscope
