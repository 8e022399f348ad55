// Where Bullet's memory comes from. Bullet asks for small blocks whenever two shapes come near each other and gives
// them back when they part: in a fall, hundreds of times. Here a block that came back waits for the next request of
// its size, and enough of them are there from the start, so that a step asks nothing of the system's heap.
//
// Sizes are powers of two from 64 bytes to 32 kB; what is larger, or finds no block waiting, comes from the heap.
// Blocks that wait are not given back. One for the program, as Bullet's hooks are; threads take turns at it, each for
// some ten instructions. Sanitizer builds go without: they could not look into it.
#pragma once

namespace kadans::bullet {

// Before the first step. Does something the first time only.
void reserve_bullet_memory() noexcept;

}  // namespace kadans::bullet
