// Ctrl-C and SIGTERM end a run after the frame being written, not in the middle of it.
#pragma once

namespace plisse {

// From now on the first SIGINT or SIGTERM is only recorded; the second ends the process at once with 128 +
// its number. May be called again.
void install_interrupt_handlers();

// Whether a signal has come; long loops ask after every frame.
bool interrupted();

// The first signal's number, 0 where none has come; 128 + it is the exit code.
int signal_number();

}  // namespace plisse
