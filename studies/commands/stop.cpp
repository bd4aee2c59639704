#include "studies/commands/stop.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace acstudy {

namespace {

std::atomic<bool> stop{false};
extern "C" void on_signal(int) { stop = true; }

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return stop;
}

bool done_before_stop(const std::atomic<bool>& stopped, std::function<void()> work) {
  using namespace std::chrono_literals;
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
  };
  const auto state = std::make_shared<State>();
  std::thread thread([state, work = std::move(work)] {
    work();
    const std::lock_guard lock(state->mutex);
    state->done = true;
    state->changed.notify_all();
  });
  std::unique_lock lock(state->mutex);
  const auto is_done = [&] { return state->done; };
  while (!state->changed.wait_for(lock, 50ms, is_done) && !stopped) continue;
  const bool done = state->changed.wait_for(lock, 500ms, is_done);
  lock.unlock();
  if (done) {
    thread.join();
  } else {
    thread.detach();
  }
  return done;
}

void leave(int status) {
  std::fflush(nullptr);
  std::_Exit(status);
}

}  // namespace acstudy
