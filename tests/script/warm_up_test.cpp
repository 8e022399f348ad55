#include "../../src/script/warm_up.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include <doctest/doctest.h>
#include <sys/mman.h>
#include <unistd.h>

using namespace kadans;

namespace {

// Pages that nobody touched; the system says which of them were read since.
class FreshPages {
 public:
  static constexpr std::size_t count = 8;
  FreshPages() : page_bytes_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    memory_ = mmap(nullptr, count * page_bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory_ != MAP_FAILED);
  }
  ~FreshPages() { munmap(memory_, count * page_bytes_); }
  FreshPages(const FreshPages&) = delete;
  FreshPages& operator=(const FreshPages&) = delete;

  // From a byte of one page to a byte of another, or the same.
  std::span<const std::byte> from_to(std::size_t first, std::size_t last) const {
    const auto* const start = static_cast<const std::byte*>(memory_);
    return {start + first * page_bytes_ + page_bytes_ - 1, start + last * page_bytes_ + 1};
  }
  std::string read() const {
    std::array<unsigned char, count> there{};
    REQUIRE(mincore(memory_, count * page_bytes_, there.data()) == 0);
    std::string text;
    for (const unsigned char page : there) text += (page & 1U) != 0 ? 'x' : '.';
    return text;
  }

 private:
  std::size_t page_bytes_;
  void* memory_ = nullptr;
};

}  // namespace

TEST_CASE("A warm-up reads all that it was told of, from the first byte to the last, and nothing else") {
  const FreshPages pages;
  WarmUp list;
  list.add(pages.from_to(0, 2));
  list.add({});
  list.add(pages.from_to(4, 5));
  CHECK(pages.read() == "........");
  list.go();
  CHECK(pages.read() == "xxx.xx..");
}

TEST_CASE("A warm-up is due when time has passed, not between ticks that follow each other at once") {
  WarmUp list;
  std::uint64_t now = 5'000'000'000;
  CHECK(list.due(now));
  for (int i = 0; i < 100; ++i) CHECK_FALSE(list.due(now += 20'000));
  CHECK(list.due(now += 10'000'000));
  CHECK_FALSE(list.due(now + 1));
}
