#pragma once
// Ctrl-C and SIGTERM set a flag; loops ask for it at step boundaries, so that what is on disk
// stays readable.

namespace concord::scene {

/// Installs handlers for SIGINT and SIGTERM. A second signal ends the program at once.
void install_interrupt_handlers();
bool interrupted() noexcept;
/// Throws Interrupted if a signal came. Call at the end of a step, after writing.
void check_interrupt();

}  // namespace concord::scene
