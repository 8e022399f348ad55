#include "byte_order.h"

#include <utility>

namespace kadans {

void ByteWriter::put_map(const TextMap& map) {
  const std::size_t start = size();
  put(std::uint32_t{0});
  for (const auto& [key, value] : map) {
    put_string(key);
    put_string(value);
  }
  set(start, static_cast<std::uint32_t>(size() - start - sizeof(std::uint32_t)));
}

std::span<const std::byte> ByteReader::take_bytes(std::uint64_t count) noexcept {
  if (count > left_.size()) {
    ok_ = false;
    left_ = {};
    return {};
  }
  const auto taken = left_.first(static_cast<std::size_t>(count));
  left_ = left_.subspan(taken.size());
  return taken;
}

std::string_view ByteReader::take_text() noexcept {
  const auto bytes = take_bytes(take<std::uint32_t>());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TextMap ByteReader::take_map() {
  TextMap map;
  ByteReader pairs(take_bytes(take<std::uint32_t>()));
  while (pairs.left() > 0) {
    std::string key = pairs.take_string();
    map.insert_or_assign(std::move(key), pairs.take_string());
  }
  ok_ = ok_ && pairs.ok();
  return map;
}

}  // namespace kadans
