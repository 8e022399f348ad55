// The preparations of commands that run in real time.
#pragma once

namespace kadans {

// Prints the missing rights. False when rights are missing and `soft` is not set; then the command must not go on.
bool rights_suffice(int priority, bool soft);

// Restarts this program once, with the arguments that it was started with, so that all functions of its libraries are
// bound before main(). Otherwise the first call of a function on a real-time thread would look it up, which takes long
// and touches much memory. Returns when the functions are bound; or when they cannot be bound, which it prints. Call it
// before any thread is started.
void bind_all_functions();

// All memory stays where it is. Without the right to it, which has been told, nothing happens.
void lock_program() noexcept;

}  // namespace kadans
