// The constants of the MCAP format (https://mcap.dev/spec, version 0). A file is the magic, records, and the magic
// again. A record is its opcode (u8), the length of its body (u64) and the body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "signal/byte_order.h"

namespace kadans {

inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t mcap_record_head = 9;  // bytes: opcode and length

enum class McapOpcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0a,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

// A record of an MCAP file under construction: the constructor writes its opcode, the destructor its length.
class McapRecord {
 public:
  McapRecord(ByteWriter& to, McapOpcode opcode) : to_(to), start_(to.size()) {
    to_.put(static_cast<std::uint8_t>(opcode));
    to_.put(std::uint64_t{0});
  }
  ~McapRecord() { to_.set(start_ + 1, static_cast<std::uint64_t>(to_.size() - start_ - mcap_record_head)); }
  McapRecord(const McapRecord&) = delete;
  McapRecord& operator=(const McapRecord&) = delete;

 private:
  ByteWriter& to_;
  std::size_t start_;
};

}  // namespace kadans
