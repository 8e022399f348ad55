#include "mcap_reader.h"

#include <cstring>
#include <utility>

#include <zstd.h>

#include "mcap_format.h"
#include "signal/crc32.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

std::string number(std::uint64_t value) { return std::to_string(value); }

constexpr std::uint64_t footer_length = 20;

}  // namespace

McapReader::McapReader(const std::string& path) : path_(path) {
  check_input_file(path);
  file_.open(path, std::ios::binary);
  file_.seekg(0, std::ios::end);
  const std::streamoff size = file_ ? static_cast<std::streamoff>(file_.tellg()) : -1;
  if (size < 0) refuse(path, "cannot be read");
  file_size_ = static_cast<std::uint64_t>(size);
  std::string magic(mcap_magic.size(), '\0');
  file_.seekg(0);
  file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (!file_ || magic != mcap_magic) refuse(path, "is not an MCAP file: it does not begin with the MCAP magic");
  position_ = magic.size();
}

bool McapReader::fail(const std::string& what) {
  if (problem_.empty()) problem_ = path_ + ": byte " + number(record_start_) + ": " + what;
  return false;
}

bool McapReader::next(McapMessage& message) {
  while (problem_.empty() && !complete_) {
    bool found = false;
    while (in_chunk_ < records_.size() && !found) {
      if (!read_in_chunk(message, found)) return false;
    }
    if (found) return true;
    if (!read_record()) return false;
  }
  return false;
}

bool McapReader::read_head(Head& head) {
  record_start_ = position_;
  const std::uint64_t left = file_size_ - position_;
  if (left < mcap_record_head) return fail(left == 0 ? "the file ends without a footer" : "the file ends in a record");
  std::uint8_t opcode = 0;
  file_.read(reinterpret_cast<char*>(&opcode), sizeof opcode);
  file_.read(reinterpret_cast<char*>(&head.length), sizeof head.length);
  if (!file_) return fail("cannot be read");
  head.opcode = static_cast<McapOpcode>(opcode);
  position_ += mcap_record_head;
  if (head.length > file_size_ - position_) {
    return fail("the file ends in a record of " + number(head.length) + " bytes");
  }
  return true;
}

bool McapReader::read_body(const Head& head, std::uint64_t limit) {
  if (head.length > limit) {
    return fail("a record of " + number(head.length) + " bytes, more than " + number(limit) + " are not read");
  }
  body_.resize(static_cast<std::size_t>(head.length));
  file_.read(reinterpret_cast<char*>(body_.data()), static_cast<std::streamsize>(body_.size()));
  position_ += head.length;
  return file_ ? true : fail("cannot be read");
}

bool McapReader::read_record() {
  Head head;
  if (!read_head(head)) return false;
  switch (head.opcode) {
    case McapOpcode::schema:
    case McapOpcode::channel:
      return read_body(head, max_record_bytes) && read_definition(head.opcode, ByteReader(body_));
    case McapOpcode::message:  // outside chunks: read as a chunk of one
      if (!read_body(head, max_chunk_bytes)) return false;
      records_.resize(mcap_record_head);
      records_[0] = static_cast<std::byte>(head.opcode);
      std::memcpy(records_.data() + 1, &head.length, sizeof head.length);
      records_.insert(records_.end(), body_.begin(), body_.end());
      in_chunk_ = 0;
      return true;
    case McapOpcode::chunk:
      return read_body(head, max_chunk_bytes) && read_chunk();
    case McapOpcode::attachment:
      return read_body(head, max_record_bytes) && read_attachment();
    case McapOpcode::metadata:
      return read_body(head, max_record_bytes) && read_metadata();
    case McapOpcode::footer:
      return read_body(head, footer_length) && finish();
    default:  // indexes are for readers that seek; unknown records are to be passed over
      file_.seekg(static_cast<std::streamoff>(head.length), std::ios::cur);
      position_ += head.length;
      return true;
  }
}

bool McapReader::finish() {
  std::string magic(mcap_magic.size(), '\0');
  file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (body_.size() != footer_length || !file_ || magic != mcap_magic) return fail("the file ends in its footer");
  complete_ = true;
  return false;
}

bool McapReader::read_definition(McapOpcode opcode, ByteReader body) {
  const auto id = body.take<std::uint16_t>();
  if (opcode == McapOpcode::schema) {
    McapSchema schema{.name = body.take_string(), .encoding = body.take_string(), .text = body.take_string()};
    if (!body.ok() || id == 0) return fail("a schema that is malformed");
    const auto [known, added] = schemas_.try_emplace(id, schema);
    return added || known->second == schema ? true : fail("schema " + number(id) + " changes");
  }
  McapChannel channel;
  channel.schema = body.take<std::uint16_t>();
  channel.topic = body.take_string();
  channel.encoding = body.take_string();
  channel.metadata = body.take_map();
  if (!body.ok()) return fail("a channel that is malformed");
  if (channel.schema != 0 && schemas_.count(channel.schema) == 0) {
    return fail("channel " + channel.topic + " has the unknown schema " + number(channel.schema));
  }
  const auto [known, added] = channels_.try_emplace(id, channel);
  return added || known->second == channel ? true : fail("channel " + number(id) + " changes");
}

bool McapReader::read_chunk() {
  ByteReader body(body_);
  body.take<std::uint64_t>();  // first and last log time
  body.take<std::uint64_t>();
  const auto size = body.take<std::uint64_t>();
  const auto crc = body.take<std::uint32_t>();
  const std::string compression = body.take_string();
  const auto packed = body.take_bytes(body.take<std::uint64_t>());
  if (!body.ok()) return fail("a chunk that is malformed");
  if (!unpack(compression, packed, size)) return false;
  if (crc != 0 && crc != crc32(records_)) {
    records_.clear();
    return fail("a chunk with the wrong CRC");
  }
  ++packing_.chunks;
  packing_.packed_bytes += packed.size();
  packing_.unpacked_bytes += size;
  packing_.compression = compression;
  in_chunk_ = 0;
  return true;
}

bool McapReader::unpack(const std::string& compression, std::span<const std::byte> packed, std::uint64_t size) {
  records_.clear();
  if (size > max_chunk_bytes) {
    return fail("a chunk of " + number(size) + " bytes, more than " + number(max_chunk_bytes) + " are not unpacked");
  }
  if (compression.empty()) {
    records_.assign(packed.begin(), packed.end());
  } else if (compression == "zstd") {
    records_.resize(static_cast<std::size_t>(size));
    const std::size_t unpacked = ZSTD_decompress(records_.data(), records_.size(), packed.data(), packed.size());
    if (ZSTD_isError(unpacked) != 0) {
      records_.clear();
      return fail(std::string("a chunk that does not unpack: ") + ZSTD_getErrorName(unpacked));
    }
    records_.resize(unpacked);
  } else {
    return fail("a chunk compressed with '" + compression + "', which is not read");
  }
  if (records_.size() == size) return true;
  records_.clear();
  return fail("a chunk whose size is not what it says");
}

bool McapReader::read_in_chunk(McapMessage& message, bool& found) {
  ByteReader records(std::span<const std::byte>(records_).subspan(in_chunk_));
  const auto opcode = static_cast<McapOpcode>(records.take<std::uint8_t>());
  const auto body = records.take_bytes(records.take<std::uint64_t>());
  in_chunk_ = records_.size() - records.left();
  if (!records.ok()) return fail("a chunk that ends in a record");
  if (opcode == McapOpcode::schema || opcode == McapOpcode::channel) return read_definition(opcode, ByteReader(body));
  if (opcode != McapOpcode::message) return true;
  ByteReader fields(body);
  message.channel = fields.take<std::uint16_t>();
  message.sequence = fields.take<std::uint32_t>();
  message.time_ns = static_cast<std::int64_t>(fields.take<std::uint64_t>());
  fields.take<std::uint64_t>();  // time of publishing
  if (!fields.ok()) return fail("a message that is malformed");
  if (channels_.count(message.channel) == 0) return fail("a message of the unknown channel " + number(message.channel));
  message.payload = body.last(fields.left());
  found = true;
  return true;
}

bool McapReader::read_attachment() {
  ByteReader body(body_);
  McapAttachment attachment;
  attachment.time_ns = static_cast<std::int64_t>(body.take<std::uint64_t>());
  body.take<std::uint64_t>();  // time of creation
  attachment.name = body.take_string();
  attachment.media_type = body.take_string();
  const auto data = body.take_bytes(body.take<std::uint64_t>());
  const std::size_t checked = body_.size() - body.left();
  const auto crc = body.take<std::uint32_t>();
  if (!body.ok()) return fail("an attachment that is malformed");
  if (crc != 0 && crc != crc32(std::span<const std::byte>(body_).first(checked))) {
    return fail("the attachment " + attachment.name + " has the wrong CRC");
  }
  attachment.data.assign(data.begin(), data.end());
  attachments_.push_back(std::move(attachment));
  return true;
}

bool McapReader::read_metadata() {
  ByteReader body(body_);
  std::string name = body.take_string();
  TextMap values = body.take_map();
  if (!body.ok()) return fail("metadata that is malformed");
  metadata_.insert_or_assign(std::move(name), std::move(values));
  return true;
}

}  // namespace kadans
