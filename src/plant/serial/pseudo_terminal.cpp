#include "pseudo_terminal.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <asm/termbits.h>
#include <fcntl.h>
#include <sys/ioctl.h>

#include "signal/input_file.h"

namespace kadans {

namespace fs = std::filesystem;

PseudoTerminal::PseudoTerminal(const std::string& link, const char* option) : link_(link) {
  const auto fail = [&](const std::string& why) { refuse(option, link_ + ": " + why); };
  master_ = OwnedDescriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const int master = master_.number();
  if (!master_ || grantpt(master) != 0 || unlockpt(master) != 0)
    fail("no pseudo-terminal: " + std::system_category().message(errno));
  char name[64];
  if (ptsname_r(master, name, sizeof name) != 0) fail("the pseudo-terminal has no name");
  slave_ = OwnedDescriptor(open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios2 terms{};
  if (!slave_ || ioctl(slave_.number(), TCGETS2, &terms) != 0) fail("the pseudo-terminal does not open");
  terms.c_iflag = terms.c_oflag = terms.c_lflag = 0;
  (void)ioctl(slave_.number(), TCSETS2, &terms);
  std::error_code error;
  if (fs::is_symlink(link_, error)) fs::remove(link_, error);  // of an emulator that was killed
  fs::create_symlink(name, link_, error);
  if (error) fail("no link can be made there: " + error.message());
}

PseudoTerminal::~PseudoTerminal() {
  if (master_) (void)unlink(link_.c_str());
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> into) const noexcept {
  const ssize_t got = ::read(master_.number(), into.data(), into.size());
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) const noexcept {
  (void)!::write(master_.number(), bytes.data(), bytes.size());
}

std::uint32_t PseudoTerminal::baud() const noexcept {
  termios2 terms{};
  return ioctl(master_.number(), TCGETS2, &terms) == 0 ? terms.c_ospeed : 0;
}

}  // namespace kadans
