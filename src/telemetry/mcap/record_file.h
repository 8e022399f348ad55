// A file to which whole blocks are appended. Errors are a state, never an exception, because nobody could handle an
// exception of a recorder whose disk is full. When a block does not fit, the file is cut back to the last whole block,
// and every later block is refused.
//
// A block is handed to the kernel at once, so it survives the end of the process, but not a loss of power.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "signal/crc32.h"

namespace kadans {

class RecordFile {
 public:
  RecordFile() = default;
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  // Replaces an existing file. False: error() says why.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool append(std::span<const std::byte> block);
  [[nodiscard]] bool close();  // false when any block, or the closing itself, failed

  bool is_open() const noexcept { return descriptor_ >= 0; }
  std::uint64_t size() const noexcept { return size_; }         // bytes of whole blocks
  std::uint32_t crc() const noexcept { return crc_.value(); }   // of all of them
  const std::string& error() const noexcept { return error_; }  // "PATH: why"; "" when there is no error

 private:
  bool fail(const char* what);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  Crc32 crc_;
  std::string error_;
};

}  // namespace kadans
