#include "studies/storing/apart.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "studies/storing/store_error.hpp"

namespace acstudy {

std::vector<char> written_apart(const std::function<void(int)>& write) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw StoreError(std::string("a pipe: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) {
    // No core of it, and no word: the parent says what is damaged.
    const rlimit none{};
    setrlimit(RLIMIT_CORE, &none);
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGALRM}) std::signal(signal, SIG_DFL);
    close(STDERR_FILENO);
    close(ends[0]);
    constexpr unsigned most_seconds = 60;
    alarm(most_seconds);
    try {
      write(ends[1]);
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  const int error = errno;
  close(ends[1]);
  std::vector<char> all;
  std::array<char, 1 << 16> block;
  for (ssize_t count = 0; child > 0;) {
    count = read(ends[0], block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    all.insert(all.end(), block.begin(), block.begin() + count);
  }
  close(ends[0]);
  if (child < 0) throw StoreError(std::string("a process: ") + std::strerror(error));
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  return all;
}

}  // namespace acstudy
