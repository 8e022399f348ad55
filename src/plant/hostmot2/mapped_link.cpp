#include "mapped_link.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "signal/input_file.h"
#include "signal/owned_descriptor.h"

namespace kadans::hostmot2 {

MappedLink::MappedLink(const std::string& path) {
  const OwnedDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_SYNC));
  const auto fail = [&](const std::string& why) { refuse("the board's registers " + path + ": " + why); };
  if (!file) fail(std::system_category().message(errno) + "; root may open a PCI resource, and who it lets");
  struct stat is {};
  if (fstat(file.number(), &is) != 0 || is.st_size < static_cast<off_t>(bytes)) fail("has no 64 KiB of registers");
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.number(), 0);
  if (memory == MAP_FAILED) fail(std::system_category().message(errno));
  registers_ = static_cast<volatile std::uint32_t*>(memory);
}

MappedLink::~MappedLink() { munmap(const_cast<std::uint32_t*>(registers_), bytes); }

bool MappedLink::read(std::uint16_t address, std::span<std::uint32_t> into) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = registers_[(address / 4U + i) % (bytes / 4)];
  return true;
}

bool MappedLink::write(RegisterWrite one) {
  registers_[one.address / 4U] = one.value;
  return true;
}

bool MappedLink::card_name(std::string& name) {
  name.clear();
  return true;
}

void MappedLink::lay_out(const TickLayout& layout) {
  layout_ = layout;
  for (const auto* blocks : {&layout.reads, &layout.writes, &layout.rare_writes}) {
    for (const RegisterBlock& block : *blocks) {
      if (block.address + 4U * block.words > bytes) throw std::length_error("a block lies beyond the registers");
    }
  }
  read_.assign(TickLayout::words(layout.reads), 0);
}

void MappedLink::send(std::span<const std::uint32_t> words) noexcept {
  sample_.heard = sample_.number++;
  sample_.time_ns = now_ns();
  std::size_t next = 0;
  for (const RegisterBlock& block : layout_.reads) {
    for (std::size_t i = 0; i < block.words; ++i) read_[next++] = registers_[block.address / 4U + i];
  }
  next = 0;
  const auto put = [&](std::span<const RegisterBlock> blocks) {
    for (const RegisterBlock& block : blocks) {
      for (std::size_t i = 0; i < block.words; ++i) registers_[block.address / 4U + i] = words[next++];
    }
  };
  put(layout_.writes);
  if (words.size() > TickLayout::words(layout_.writes)) put(layout_.rare_writes);
  ++counts_.sent;
  fresh_ = true;
}

bool MappedLink::collect(std::span<std::uint32_t> words, Sample& sample) noexcept {
  if (!std::exchange(fresh_, false)) return false;
  std::copy_n(read_.begin(), std::min(words.size(), read_.size()), words.begin());
  sample = sample_;
  ++counts_.received;
  return true;
}

void MappedLink::write_all(std::span<const RegisterWrite> writes) noexcept {
  for (const RegisterWrite& one : writes) registers_[one.address / 4U] = one.value;
}

}  // namespace kadans::hostmot2
