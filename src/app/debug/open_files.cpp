#include "open_files.h"

#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "signal/number_text.h"

namespace kadans {

OpenFiles::OpenFiles() {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const auto descriptor = number_of<int>(entry.path().filename().string());
    struct stat facts {};
    if (!descriptor || fstat(*descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) continue;
    if ((fcntl(*descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY) continue;
    files_.push_back({*descriptor, lseek(*descriptor, 0, SEEK_CUR)});
  }
}

void OpenFiles::open_again() const noexcept {
  for (const auto& [descriptor, place] : files_) {
    const int fresh = open(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), O_RDONLY | O_CLOEXEC);
    if (fresh < 0) _exit(1);
    (void)lseek(fresh, place, SEEK_SET);
    (void)dup3(fresh, descriptor, O_CLOEXEC);
    close(fresh);
  }
}

}  // namespace kadans
