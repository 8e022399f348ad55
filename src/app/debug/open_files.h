// Files that this process reads. A copy of a process shares the places up to which they are read; so it opens them
// again, each at the place where it was when the copy was made.
#pragma once

#include <vector>

#include <sys/types.h>

namespace kadans {

class OpenFiles {
 public:
  OpenFiles();                       // before the copy is made
  void open_again() const noexcept;  // in the copy

 private:
  struct File {
    int descriptor;
    off_t place;
  };
  std::vector<File> files_;
};

}  // namespace kadans
