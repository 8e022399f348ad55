// Keys from the standard input, one by one and without waiting, while this lives.
#pragma once

#include <string_view>

#include <termios.h>

namespace kadans {

class Keys {
 public:
  Keys();
  ~Keys();
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  bool is_terminal() const noexcept { return is_terminal_; }
  // What was pressed since the last call; it holds until the next one. `gone`: nobody can press a key any more.
  std::string_view pressed(bool& gone) noexcept;

 private:
  int flags_;
  bool is_terminal_ = false;
  termios before_{};
  char keys_[64]{};
};

}  // namespace kadans
