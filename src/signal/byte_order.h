// Little-endian fields in memory, as MCAP and CDR need them, and maps of texts, which are such fields, too. ByteWriter
// appends, ByteReader takes and trusts nothing.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand in memory");

template <typename T>
concept Number = std::integral<T> || std::floating_point<T>;

using TextMap = std::map<std::string, std::string>;
// "" when there is none of this name.
inline std::string fact_in(const TextMap& facts, const std::string& name) {
  const auto found = facts.find(name);
  return found == facts.end() ? "" : found->second;
}

inline std::span<const std::byte> bytes_of(std::string_view text) noexcept {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// Appends to a buffer that keeps its memory from one use to the next. Strings and maps as MCAP has them: a string is
// its u32 length and its bytes, a map its u32 length in bytes and its pairs.
class ByteWriter {
 public:
  template <Number T>
  void put(T value) {
    put(std::as_bytes(std::span(&value, 1)));
  }
  void put(std::span<const std::byte> bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }
  void put_string(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    put(bytes_of(text));
  }
  void put_map(const TextMap& map);

  // Overwrites what was put at `offset`: lengths are known last.
  template <Number T>
  void set(std::size_t offset, T value) noexcept {
    std::memcpy(buffer_.data() + offset, &value, sizeof value);
  }
  // Appends `count` bytes that the caller fills in; the span is valid until the next call.
  std::span<std::byte> grow(std::size_t count) {
    buffer_.resize(buffer_.size() + count);
    return std::span(buffer_).last(count);
  }
  void reserve(std::size_t size) { buffer_.reserve(size); }
  void shrink(std::size_t size) { buffer_.resize(size); }

  void clear() noexcept { buffer_.clear(); }
  std::size_t size() const noexcept { return buffer_.size(); }
  std::span<const std::byte> bytes() const noexcept { return buffer_; }

 private:
  std::vector<std::byte> buffer_;
};

// Takes fields from the front of bytes from outside. A field that is not there is read as zero or empty, and ok() is
// false from then on. A length beyond the bytes that are left is not accepted.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) noexcept : left_(bytes) {}

  template <Number T>
  T take() noexcept {
    T value{};
    const std::span<const std::byte> from = take_bytes(sizeof value);
    if (!from.empty()) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) noexcept;  // all of `count`, or none
  std::string_view take_text() noexcept;                                // into the bytes that are read
  std::string take_string() { return std::string(take_text()); }
  TextMap take_map();

  bool ok() const noexcept { return ok_; }
  std::size_t left() const noexcept { return left_.size(); }

 private:
  std::span<const std::byte> left_;
  bool ok_ = true;
};

}  // namespace kadans
