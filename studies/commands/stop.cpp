#include "studies/commands/stop.hpp"

#include <csignal>

namespace acstudy {

namespace {

std::atomic<bool> stop{false};
extern "C" void on_signal(int) { stop = true; }

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  return stop;
}

}  // namespace acstudy
