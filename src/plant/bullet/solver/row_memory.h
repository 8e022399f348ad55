// Memory for the numbers of one step's rows. It is handed out in order and given back all at once. It grows when a step
// needs more than any step before; memory that was handed out stays where it is.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <LinearMath/btScalar.h>

namespace kadans::bullet {

class RowMemory {
 public:
  btScalar* take(std::size_t count) {
    if (blocks_.empty() || used_ + count > block_size) next_block();
    btScalar* const taken = blocks_[block_].get() + used_;
    used_ += count + count % 2;  // aligned for two numbers at a time
    return taken;
  }
  void clear() { block_ = used_ = 0; }

 private:
  static constexpr std::size_t block_size = 16384;

  void next_block() {
    if (!blocks_.empty()) ++block_;
    if (block_ == blocks_.size()) blocks_.push_back(std::make_unique<btScalar[]>(block_size));
    used_ = 0;
  }

  std::vector<std::unique_ptr<btScalar[]>> blocks_;
  std::size_t block_ = 0, used_ = 0;
};

}  // namespace kadans::bullet
