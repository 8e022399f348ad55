#include "durable_file.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_file.h"
#include "kadans/signal/output_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  // `path` is opened, `named` is what complaints are about.
  Descriptor(const fs::path& path, int flags, const fs::path& named)
      : path_(named), file_(open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (file_ < 0) fail("cannot be written");
  }
  ~Descriptor() {
    if (file_ >= 0) close(file_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = write(file_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("cannot be written");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  // As the file that it takes the place of, if the system lets it.
  void look_like(const fs::path& file) const {
    struct stat old {};
    if (stat(file.c_str(), &old) != 0) return;
    if (fchown(file_, old.st_uid, old.st_gid) != 0 && fchown(file_, static_cast<uid_t>(-1), old.st_gid) != 0) {
    }
    if (fchmod(file_, old.st_mode & 07777U) != 0) fail("cannot be given its mode");
  }
  void sync() const {
    if (fsync(file_) != 0) fail("cannot be forced to the disk");
  }
  void finish() {
    if (close(std::exchange(file_, -1)) != 0) fail("cannot be written");
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    refuse(path_, what + (": " + std::generic_category().message(errno)));
  }
  fs::path path_;
  int file_;
};

void replace(const fs::path& file, std::string_view bytes) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::path temporary = folder / ("." + file.filename().string() + "." + std::to_string(getpid()) + ".part");
  try {
    const Descriptor descriptor(temporary, O_WRONLY | O_CREAT | O_TRUNC, file);
    descriptor.look_like(file);
    descriptor.write_all(bytes);
    descriptor.sync();
    std::error_code error;
    fs::rename(temporary, file, error);
    if (error) refuse(file, "cannot be replaced: " + error.message());
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
  Descriptor(folder, O_RDONLY | O_DIRECTORY, folder).sync();
}

}  // namespace

bool is_device_or_pipe(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

fs::path end_of_link(const fs::path& file) {
  constexpr int links_max = 40;              // as the system's own
  if (is_device_or_pipe(file)) return file;  // a pipe behind /dev/stdout has no name
  fs::path end = file;
  std::error_code error;
  for (int i = 0; fs::is_symlink(fs::symlink_status(end, error)); ++i) {
    const fs::path target = fs::read_symlink(end, error);
    if (error || i == links_max) refuse(file, "is a link that leads nowhere");
    end = end.parent_path() / target;  // or the target alone, when that is absolute
  }
  return end;
}

void write_durably(const fs::path& file, std::string_view bytes) {
  if (!is_device_or_pipe(file)) return replace(end_of_link(file), bytes);
  Descriptor descriptor(file, O_WRONLY, file);
  descriptor.write_all(bytes);
  descriptor.finish();
}

void write_output_file(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (error) refuse(file.parent_path(), "cannot be made: " + error.message());
  write_durably(file, bytes);
}

}  // namespace kadans
