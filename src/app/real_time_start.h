// What the commands that run in real time ask of the machine before they start.
#pragma once

namespace kadans {

// Says what is missing. False when the command must not go on without: it is, and `soft` is not set.
bool rights_suffice(int priority, bool soft);

// All memory stays where it is, but for libraries that no real-time thread calls; Bullet is one of them without a
// model. Without the right to it, which has been told, nothing happens.
void lock_program(bool with_model) noexcept;

}  // namespace kadans
