// A file that only grows, one whole block at a time. Its errors are a state, never an exception: a recorder whose disk
// is full has nobody to throw at. After a block that did not fit, the file is cut back to the last whole one, and every
// later block is refused.
//
// Blocks reach the kernel at once, so what was appended outlives the process (not the power).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "kadans/signal/crc32.h"

namespace kadans {

class RecordFile {
 public:
  RecordFile() = default;
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  // Replaces a file of that name. False: error() says why.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool append(std::span<const std::byte> block);
  [[nodiscard]] bool close();  // false when any block, or the closing itself, failed

  bool is_open() const noexcept { return descriptor_ >= 0; }
  std::uint64_t size() const noexcept { return size_; }         // bytes of whole blocks
  std::uint32_t crc() const noexcept { return crc_.value(); }   // of all of them
  const std::string& error() const noexcept { return error_; }  // "" while all is well; "PATH: why"

 private:
  bool fail(const char* what);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  Crc32 crc_;
  std::string error_;
};

}  // namespace kadans
