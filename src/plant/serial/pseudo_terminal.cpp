#include "pseudo_terminal.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <asm/termbits.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "signal/input_file.h"

namespace kadans {

namespace fs = std::filesystem;

PseudoTerminal::PseudoTerminal(const std::string& link, const char* option) : link_(link) {
  try {
    open_terminal(option);
  } catch (...) {
    if (slave_ >= 0) close(slave_);
    if (master_ >= 0) close(master_);
    throw;
  }
}

void PseudoTerminal::open_terminal(const char* option) {
  const auto fail = [&](const std::string& why) { refuse(option, link_ + ": " + why); };
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0)
    fail("no pseudo-terminal: " + std::system_category().message(errno));
  char name[64];
  if (ptsname_r(master_, name, sizeof name) != 0) fail("the pseudo-terminal has no name");
  slave_ = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios2 terms{};
  if (slave_ < 0 || ioctl(slave_, TCGETS2, &terms) != 0) fail("the pseudo-terminal does not open");
  terms.c_iflag = terms.c_oflag = terms.c_lflag = 0;
  (void)ioctl(slave_, TCSETS2, &terms);
  std::error_code error;
  if (fs::is_symlink(link_, error)) fs::remove(link_, error);  // of an emulator that was killed
  fs::create_symlink(name, link_, error);
  if (error) fail("no link can be made there: " + error.message());
}

PseudoTerminal::PseudoTerminal(PseudoTerminal&& other) noexcept
    : link_(std::move(other.link_)),
      master_(std::exchange(other.master_, -1)),
      slave_(std::exchange(other.slave_, -1)) {}

PseudoTerminal::~PseudoTerminal() {
  if (master_ < 0) return;
  (void)unlink(link_.c_str());
  close(slave_);
  close(master_);
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> into) const noexcept {
  const ssize_t got = ::read(master_, into.data(), into.size());
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) const noexcept {
  (void)!::write(master_, bytes.data(), bytes.size());
}

std::uint32_t PseudoTerminal::baud() const noexcept {
  termios2 terms{};
  return ioctl(master_, TCGETS2, &terms) == 0 ? terms.c_ospeed : 0;
}

}  // namespace kadans
