
#include "input_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "number_text.h"
#include "owned_descriptor.h"

namespace kadans {

void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError({.file = file.string(), .message = why});
}
void refuse(const std::string& why) { throw InputError({.message = why}); }

namespace {

std::string reason() { return std::generic_category().message(errno); }

// Open for reading; what it is, is looked at before and after: to open a device may have an effect.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file) {
    struct stat found {};
    if (stat(file.c_str(), &found) != 0)
      refuse(file, errno == ENOENT || errno == ENOTDIR ? "there is no such file" : "cannot be read: " + reason());
    check(file, found);
    opened_ = OwnedDescriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!opened_) refuse(file, "cannot be read: " + reason());
    if (fstat(number(), &found) != 0 || !S_ISREG(found.st_mode)) refuse(file, "this is no file");
  }

  int number() const noexcept { return opened_.number(); }

 private:
  static void check(const std::filesystem::path& file, const struct stat& found) {
    if (S_ISDIR(found.st_mode)) refuse(file, "this is a folder, not a file");
    if (!S_ISREG(found.st_mode)) refuse(file, "this is no file but a device, a pipe or a socket");
  }
  OwnedDescriptor opened_;
};

}  // namespace

std::string read_input_file(const std::filesystem::path& file, std::size_t size_max_bytes) {
  constexpr std::size_t piece_bytes = std::size_t{16} << 10U;  // each is cleared first, and most files are small
  const OpenFile opened(file);
  std::string text;
  for (;;) {
    const std::size_t had = text.size();
    text.resize(had + piece_bytes);
    const ssize_t count = read(opened.number(), text.data() + had, piece_bytes);
    if (count < 0 && errno != EINTR) refuse(file, "cannot be read: " + reason());
    text.resize(had + static_cast<std::size_t>(count > 0 ? count : 0));
    if (text.size() > size_max_bytes)
      refuse(file, "the file is larger than " + std::to_string(size_max_bytes >> 20U) + " MB");
    if (count == 0) break;
  }
  text.shrink_to_fit();
  return text;
}

void check_input_file(const std::filesystem::path& file) { const OpenFile opened(file); }

std::string InputProblem::text() const {
  std::string place = file;
  if (line > 0) place += (file.empty() ? "" : ":") + std::to_string(line);
  if (line > 0 && column > 0) place += ':' + std::to_string(column);
  return place.empty() ? message : place + ": " + message;
}

InputError::InputError(InputProblem problem) : InputError(std::vector<InputProblem>{std::move(problem)}) {}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(listed(problems, &InputProblem::text, "\n")), problems_(std::move(problems)) {}

}  // namespace kadans
