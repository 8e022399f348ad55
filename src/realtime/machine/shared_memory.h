// Memory that two processes share. It has no name, so that nobody else finds it and nothing of it outlives them.
#pragma once

#include <cstddef>
#include <utility>

namespace kadans {

class SharedMemory {
 public:
  // New memory, all zero. Its descriptor is closed in programs that are started. Throws std::system_error.
  explicit SharedMemory(std::size_t bytes);
  // The memory of another process; takes the descriptor over. Throws std::system_error, also when it is smaller.
  SharedMemory(int descriptor, std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  void* get() const noexcept { return memory_; }
  int descriptor() const noexcept { return descriptor_; }

 private:
  void map();

  int descriptor_;
  std::size_t bytes_;
  void* memory_ = nullptr;
};

}  // namespace kadans
