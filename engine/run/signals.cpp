#include "engine/run/signals.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

namespace sluice {
namespace {

// Lock-free atomics are what a signal handler may touch.
std::atomic<bool> g_checkpoint{false};
std::atomic<int> g_stops{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void on_checkpoint(int) { g_checkpoint.store(true); }

void on_stop(int signal_number) {
  if (g_stops.fetch_add(1) > 0) _exit(128 + signal_number);
}

struct Action {
  int signal_number;
  void (*handler)(int);
};
const std::array<Action, 6> kActions{{{SIGUSR1, on_checkpoint},
                                      {SIGTERM, on_stop},
                                      {SIGINT, on_stop},
                                      {SIGHUP, on_stop},
                                      {SIGPIPE, SIG_IGN},
                                      {SIGXFSZ, SIG_IGN}}};
std::array<struct sigaction, kActions.size()> g_previous;

}  // namespace

SignalRequests::SignalRequests() {
  g_checkpoint = false;
  g_stops = 0;
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = kActions[i].handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(kActions[i].signal_number, nullptr, &g_previous[i]);
    // A program started with nohup stays deaf to the terminal that goes away.
    const bool stays_ignored =
        kActions[i].signal_number == SIGHUP && g_previous[i].sa_handler == SIG_IGN;
    if (!stays_ignored) sigaction(kActions[i].signal_number, &action, nullptr);
  }
}

SignalRequests::~SignalRequests() {
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    sigaction(kActions[i].signal_number, &g_previous[i], nullptr);
  }
}

Request SignalRequests::take() {
  if (stop_requested()) return Request::stop;
  return g_checkpoint.exchange(false) ? Request::checkpoint : Request::none;
}

bool SignalRequests::stop_requested() const { return g_stops.load() > 0; }

}  // namespace sluice
