// Where Bullet's memory comes from. Bullet asks for small blocks whenever two shapes come near each other and gives
// them back when they part: in a fall, hundreds of times. Here a block that came back waits for the next request of its
// size. Enough blocks are there from the start, so that a step needs nothing from the system's heap.
//
// Sizes are powers of two from 64 bytes to 32 kB. A larger block comes from the heap, and so does a block of a size of
// which none waits. Blocks that wait are not given back. There is one memory for the program, because Bullet's hooks
// are global. Threads take turns at it, each for some ten instructions. Sanitizer builds do not use it: they could not
// look into it.
#pragma once

namespace kadans::bullet {

// To be called before the first step. Only the first call has an effect.
void reserve_bullet_memory() noexcept;

}  // namespace kadans::bullet
