#include "engine/run/signals.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <vector>

#include "engine/run/stop_wish.hpp"

namespace sluice {
namespace {

// Lock-free atomics are what a signal handler may touch.
std::atomic<bool> g_checkpoint{false};
std::atomic<int> g_emptied{-1};
StopWish g_stop;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void on_checkpoint(int) { g_checkpoint.store(true); }

void on_stop(int signal_number) {
  if (g_stop.take() != StopWish::Kind::at_once) return;
  [[maybe_unused]] const int result = ::ftruncate(g_emptied, 0);
  ::_exit(128 + signal_number);
}

struct Action {
  int signal_number;
  void (*handler)(int);
};

std::vector<Action> actions() {
  std::vector<Action> all{{SIGUSR1, on_checkpoint}, {SIGPIPE, SIG_IGN}, {SIGXFSZ, SIG_IGN}};
  for (const int number : stop_signals()) all.push_back({number, on_stop});
  return all;
}

struct Previous {
  int signal_number;
  struct sigaction action;
};
std::vector<Previous> g_previous;
int g_holders = 0;

}  // namespace

SignalRequests::SignalRequests() {
  if (g_holders++ > 0) return;
  g_checkpoint = false;
  g_stop.forget();
  g_previous.clear();
  for (const Action& wanted : actions()) {
    struct sigaction action {};
    action.sa_handler = wanted.handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    struct sigaction before {};
    sigaction(wanted.signal_number, &action, &before);
    g_previous.push_back({wanted.signal_number, before});
  }
}

SignalRequests::~SignalRequests() {
  g_emptied = -1;
  if (--g_holders > 0) return;
  for (const Previous& previous : g_previous) {
    sigaction(previous.signal_number, &previous.action, nullptr);
  }
}

RunRequest SignalRequests::take() {
  if (stop_requested()) return RunRequest::stop;
  return g_checkpoint.exchange(false) ? RunRequest::checkpoint : RunRequest::none;
}

void SignalRequests::empty_when_ended_at_once(int descriptor) { g_emptied = descriptor; }

bool SignalRequests::stop_requested() const { return g_stop.asked(); }

}  // namespace sluice
