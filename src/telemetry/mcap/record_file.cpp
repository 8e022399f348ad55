#include "record_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace kadans {

static_assert(sizeof(off_t) == 8, "records may pass 2 GB on 32-bit machines too");

RecordFile::~RecordFile() {
  if (is_open()) ::close(descriptor_);
}

bool RecordFile::fail(const char* what) {
  const std::string reason = std::generic_category().message(errno);
  if (error_.empty()) error_ = path_ + ": " + what + ": " + reason;
  return false;
}

bool RecordFile::open(const std::string& path) {
  if (is_open()) ::close(descriptor_);
  path_ = path;
  size_ = 0;
  crc_ = Crc32{};
  error_.clear();
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0644);
  return is_open() || fail("cannot create the record");
}

bool RecordFile::append(std::span<const std::byte> block) {
  if (!is_open() || !error_.empty()) return false;
  for (std::span<const std::byte> left = block; !left.empty();) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const bool failed = fail("cannot write the record");
      // Half a block is of no use. A device or pipe cannot be cut; its reader copes with a record that ends early.
      (void)(::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0);
      return failed;
    }
    left = left.subspan(static_cast<std::size_t>(written));
  }
  size_ += block.size();
  crc_.add(block);
  return true;
}

bool RecordFile::close() {
  if (!is_open()) return error_.empty();
  const bool closed = ::close(descriptor_) == 0;
  descriptor_ = -1;
  if (!closed) return fail("cannot close the record");
  return error_.empty();
}

}  // namespace kadans
