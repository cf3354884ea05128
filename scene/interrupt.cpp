#include "scene/interrupt.hpp"

#include "scene/errors.hpp"

#include <csignal>

namespace concord::scene {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;

extern "C" void on_interrupt(int signal) {
  if (g_interrupted != 0) {  // the second one: end at once, with the system's own action
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  g_interrupted = 1;
}

}  // namespace

void install_interrupt_handlers() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes fails the write, like a full disk
}

bool interrupted() noexcept { return g_interrupted != 0; }

void check_interrupt() {
  if (interrupted()) throw Interrupted();
}

}  // namespace concord::scene
