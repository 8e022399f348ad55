#include "register_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::hostmot2 {
namespace {

constexpr std::size_t file_bytes = 0x10000, used_bytes = 0x5000;
// No pin has this bit: it tells the state of pins, which is shown, from an output that was written with the same bits.
constexpr std::uint32_t shown_pins = 0x80000000;

bool readable(unsigned address) noexcept {
  const unsigned block = address & 0xFF00U;
  return (address >= 0x100 && address < 0x200) || (address >= 0x400 && address < 0x1200) || block == 0x3000 ||
         block == 0x3100 || block == 0x3300;
}

}  // namespace

RegisterFile::RegisterFile(EmulatedBoard& board, const std::string& path) : board_(board), shown_(used_bytes / 4) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const bool good = file >= 0 && ftruncate(file, file_bytes) == 0;
  void* const memory = good ? mmap(nullptr, file_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
  const int error = errno;
  if (file >= 0) ::close(file);
  if (memory == MAP_FAILED) throw InputError({.message = path + ": " + std::system_category().message(error)});
  registers_ = static_cast<volatile std::uint32_t*>(memory);
  for (std::size_t i = 0; i < shown_.size(); ++i) registers_[i] = 0;
  show();
}

RegisterFile::~RegisterFile() { munmap(const_cast<std::uint32_t*>(registers_), file_bytes); }

void RegisterFile::take() noexcept {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const std::uint32_t is = registers_[i];
    if (is == shown_[i]) continue;
    (void)board_.write(static_cast<unsigned>(4 * i), is);
    shown_[i] = is;
  }
}

void RegisterFile::show() noexcept {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const auto address = static_cast<unsigned>(4 * i);
    std::uint32_t is = 0;
    if (!readable(address) || !board_.read(address, is)) continue;
    if ((address & 0xFF00U) == 0x1000) is |= shown_pins;
    registers_[i] = shown_[i] = is;
  }
}

}  // namespace kadans::hostmot2
