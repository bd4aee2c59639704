#include "studies/running/program/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <mutex>
#include <system_error>
#include <utility>

extern "C" char** environ;

namespace acstudy {

namespace {

[[noreturn]] void fail(int error, const char* what) { throw std::system_error(error, std::generic_category(), what); }

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// The same file under a number that no standard stream has, which no program inherits.
Descriptor inherited_by_none(int number) {
  const int copy = fcntl(number, F_DUPFD_CLOEXEC, 3);
  const int error = errno;
  ::close(number);
  if (copy < 0) fail(error, "a pipe");
  return Descriptor(copy);
}

struct Pipe {
  Pipe() : Pipe(ends()) {}
  Descriptor read, write;

 private:
  static std::array<int, 2> ends() {
    std::array<int, 2> numbers{};
    if (pipe(numbers.data()) != 0) fail(errno, "a pipe");
    return numbers;
  }
  explicit Pipe(std::array<int, 2> numbers)
      : read(inherited_by_none(numbers[0])), write(inherited_by_none(numbers[1])) {}
};

/// What is to be done in the new process before it becomes the program.
class Spawn {
 public:
  Spawn() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    // Signals as a shell leaves them: no handler and no mask of this process.
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGPIPE}) sigaddset(&usual, signal);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Spawn() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;

  void stream(int from, int to) { posix_spawn_file_actions_adddup2(&actions_, from, to); }
  void folder(const std::string& name) {
    if (!name.empty()) posix_spawn_file_actions_addchdir_np(&actions_, name.c_str());
  }
  /// An error number, 0 if it runs.
  int start(const std::vector<std::string>& command, pid_t& child) {
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    return posix_spawnp(&child, words.front(), &actions_, &attributes_, words.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

/// Reads what is there, but not much at once, so that nothing else waits; closes the stream at its end.
void read_some(Descriptor& stream, std::string& to) {
  std::array<char, 1 << 16> block;
  const ssize_t count = ::read(stream.number(), block.data(), block.size());
  if (count > 0) to.append(block.data(), static_cast<std::size_t>(count));
  if (count == 0) stream.close();
}

void keep_the_end(std::string& messages) {
  if (messages.size() > kept_messages) messages.erase(0, messages.size() - kept_messages);
}

class Running {
 public:
  Running(const std::vector<std::string>& command, const std::string& folder, std::FILE* input) {
    // A pipe that another program inherits in the moment before it is closed to that would stay open as long as it
    // runs.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    Pipe out, messages;
    Spawn spawn;
    spawn.stream(fileno(input), STDIN_FILENO);
    spawn.stream(out.write.number(), STDOUT_FILENO);
    spawn.stream(messages.write.number(), STDERR_FILENO);
    spawn.folder(folder);
    error_ = spawn.start(command, child_);
    out_ = std::move(out.read);
    messages_ = std::move(messages.read);
    for (const Descriptor* stream : {&out_, &messages_}) fcntl(stream->number(), F_SETFL, O_NONBLOCK);
  }

  ProcessEnd wait(const ProcessLimits& limits, const std::atomic<bool>& stop) {
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    const auto passed = [&] { return std::chrono::duration<double>(clock::now() - start).count(); };
    ProcessEnd end;
    if (error_ != 0) {
      end.how = ProcessEnd::How::not_started;
      end.code = error_;
      return end;
    }
    int pause = 1;  // ms, once nothing can be read any more
    while (!ended()) {
      end.how = stop                                  ? ProcessEnd::How::interrupted
                : passed() > limits.seconds           ? ProcessEnd::How::timed_out
                : end.out.size() > limits.most_output ? ProcessEnd::How::wrote_too_much
                                                      : ProcessEnd::How::exited;
      if (end.how != ProcessEnd::How::exited) break;
      read(end, out_.is_open() || messages_.is_open() ? 50 : std::exchange(pause, std::min(2 * pause, 20)));
    }
    end.seconds = passed();
    // Before it is waited for, as its number is that of the group until then.
    kill(-child_, SIGKILL);
    int status = 0;
    while (waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
    // What is left in the pipes; who has left the group and writes on is not waited for.
    constexpr int blocks_of_a_pipe = 32;
    for (int i = 0; i < blocks_of_a_pipe && end.out.size() <= limits.most_output; ++i) read(end, 0);
    if (end.how != ProcessEnd::How::exited) return end;
    if (end.out.size() > limits.most_output) {
      end.how = ProcessEnd::How::wrote_too_much;
    } else if (WIFSIGNALED(status)) {
      end.how = ProcessEnd::How::signaled;
      end.code = WTERMSIG(status);
    } else {
      end.code = WEXITSTATUS(status);
    }
    return end;
  }

 private:
  /// True once the program itself has ended; it stays to be waited for.
  bool ended() const {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child_;
  }

  void read(ProcessEnd& end, int milliseconds) {
    std::array<pollfd, 2> streams = {pollfd{out_.number(), POLLIN, 0}, pollfd{messages_.number(), POLLIN, 0}};
    if (poll(streams.data(), streams.size(), milliseconds) <= 0) return;  // a closed one has a negative number
    if (streams[0].revents != 0) read_some(out_, end.out);
    if (streams[1].revents != 0) read_some(messages_, end.messages);
    keep_the_end(end.messages);
  }

  pid_t child_ = 0;
  int error_ = 0;
  Descriptor out_, messages_;
};

}  // namespace

TemporaryFile file_of(const std::string& text) {
  TemporaryFile file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0) {
    fail(errno, "a temporary file");
  }
  std::rewind(file.get());
  return file;
}

ProcessEnd run_process(const std::vector<std::string>& command, const std::string& folder, std::FILE* input,
                       const ProcessLimits& limits, const std::atomic<bool>& stop) {
  return Running(command, folder, input).wait(limits, stop);
}

}  // namespace acstudy
