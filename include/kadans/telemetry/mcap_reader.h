// Reads MCAP from the front, message by message, as far as the file goes.
//
// A record of a run that was killed ends anywhere; what stands before is delivered, then problem() says where and why
// it stopped. Nothing in the file is trusted: a length is believed only within the bytes that are there, a chunk is
// unpacked only up to max_chunk_bytes, every CRC that is given is checked. Compressions: none and zstd.
// One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/byte_order.h"
#include "kadans/telemetry/mcap_format.h"

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
  std::span<const std::byte> payload;  // holds until the reader moves on
};

struct McapAttachment {
  std::string name, media_type;
  std::int64_t time_ns = 0;
  std::vector<std::byte> data;
};

class McapReader {
 public:
  static constexpr std::uint64_t max_chunk_bytes = 64U << 20U;    // packed or not
  static constexpr std::uint64_t max_record_bytes = 256U << 20U;  // of any other record that is kept

  // Throws InputError when the file cannot be read or is no MCAP file.
  explicit McapReader(const std::string& path);

  // The next message in the order of the file. False at the end, or at the first problem.
  [[nodiscard]] bool next(McapMessage& message);
  // Whether the file was read to a proper end. If not, and next() has returned false, problem() says what is wrong.
  bool complete() const noexcept { return complete_; }
  const std::string& problem() const noexcept { return problem_; }  // "FILE: byte N: what"

  std::uint64_t file_bytes() const noexcept { return file_size_; }

  // As far as the file has been read.
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
