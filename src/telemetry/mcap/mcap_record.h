// A record of an MCAP file under construction: the constructor writes its opcode, the destructor its length.
#pragma once

#include "mcap_format.h"
#include "signal/byte_order.h"

namespace kadans {

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

inline void put_schema(ByteWriter& to, std::uint16_t id, std::string_view name, std::string_view encoding,
                       std::string_view text) {
  const McapRecord record(to, McapOpcode::schema);
  to.put(id);
  to.put_string(name);
  to.put_string(encoding);
  to.put_string(text);
}

inline void put_channel(ByteWriter& to, std::uint16_t id, std::uint16_t schema, std::string_view topic,
                        std::string_view encoding, const TextMap& metadata) {
  const McapRecord record(to, McapOpcode::channel);
  to.put(id);
  to.put(schema);
  to.put_string(topic);
  to.put_string(encoding);
  to.put_map(metadata);
}

}  // namespace kadans
