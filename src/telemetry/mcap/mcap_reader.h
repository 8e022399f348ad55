// Reads an MCAP file from the front, message by message, as far as the file goes.
//
// A record of a run that was killed may end at any byte. The reader delivers the messages before that point; then
// problem() says where and why it stopped. The reader trusts nothing in the file: a length must fit the bytes that
// exist, a chunk is unpacked only up to max_chunk_bytes, and every CRC that is given is checked. It knows the
// compressions none and zstd. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mcap_format.h"
#include "signal/byte_order.h"

namespace kadans {

struct McapSchema {
  std::string name, encoding, text;
  friend bool operator==(const McapSchema&, const McapSchema&) = default;
};

struct McapChannel {
  std::string topic, encoding;
  std::uint16_t schema = 0;
  TextMap metadata;
  friend bool operator==(const McapChannel&, const McapChannel&) = default;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::int64_t time_ns = 0;
  std::span<const std::byte> payload;  // valid until the next call of next()
};

struct McapAttachment {
  std::string name, media_type;
  std::int64_t time_ns = 0;
  std::vector<std::byte> data;
};

class McapReader {
 public:
  static constexpr std::uint64_t max_chunk_bytes = 64U << 20U;    // compressed or not
  static constexpr std::uint64_t max_record_bytes = 256U << 20U;  // of any other record that is stored

  // Throws InputError when the file cannot be read or is no MCAP file.
  explicit McapReader(const std::string& path);

  // The next message in the order of the file. False at the end, or at the first problem.
  [[nodiscard]] bool next(McapMessage& message);
  // True when the file was read to a proper end. If it is false after next() has returned false, problem() says why.
  bool complete() const noexcept { return complete_; }
  const std::string& problem() const noexcept { return problem_; }  // "FILE: byte N: what"

  std::uint64_t file_bytes() const noexcept { return file_size_; }

  // Counts the part of the file that has been read.
  struct Packing {
    std::uint64_t chunks = 0, packed_bytes = 0, unpacked_bytes = 0;
    std::string compression;  // of the last chunk: "", "zstd"
  };
  const Packing& packing() const noexcept { return packing_; }
  const std::map<std::uint16_t, McapSchema>& schemas() const noexcept { return schemas_; }
  const std::map<std::uint16_t, McapChannel>& channels() const noexcept { return channels_; }
  const std::vector<McapAttachment>& attachments() const noexcept { return attachments_; }
  const std::map<std::string, TextMap>& metadata() const noexcept { return metadata_; }

 private:
  struct Head {
    McapOpcode opcode{};
    std::uint64_t length = 0;
  };
  bool fail(const std::string& what);
  bool read_head(Head& head);
  bool read_record();  // one record outside chunks; false at the end or at a problem
  bool read_body(const Head& head, std::uint64_t limit);
  bool read_chunk();
  bool unpack(const std::string& compression, std::span<const std::byte> packed, std::uint64_t size);
  bool read_attachment();
  bool read_metadata();
  bool read_definition(McapOpcode opcode, ByteReader body);
  bool read_in_chunk(McapMessage& message, bool& found);
  bool finish();

  std::string path_;
  std::ifstream file_;
  std::uint64_t file_size_ = 0, position_ = 0, record_start_ = 0;
  bool complete_ = false;
  std::string problem_;

  std::vector<std::byte> body_;     // of the record being read
  std::vector<std::byte> records_;  // of the chunk being read
  std::size_t in_chunk_ = 0;        // where the next record of the chunk begins

  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<McapAttachment> attachments_;
  std::map<std::string, TextMap> metadata_;
  Packing packing_;
};

}  // namespace kadans
