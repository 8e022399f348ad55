// Writes MCAP, the log file format that robotics tools read (https://mcap.dev/spec).
//
// Messages are collected in a chunk in memory. When the chunk holds chunk_period_ns of log time or chunk_bytes, it is
// compressed, gets its CRC, and is appended to the file in one block together with its message indexes. A schema and a
// channel stand before their first message, and in the summary. So a file that is cut short at any byte, by a full disk
// or a killed process, can be read up to the last whole chunk. close() adds the summary that lets readers seek.
//
// One thread at a time. Disk errors are a state, not exceptions: calls return false, error() says why, and the file
// keeps its whole chunks. The same calls make the same bytes: nothing in the file comes from a clock or the machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mcap_format.h"
#include "signal/byte_order.h"
#include "signal/crc32.h"

struct ZSTD_CCtx_s;

namespace kadans {

// A file to which whole blocks are appended. Errors are a state, never an exception, because nobody could handle an
// exception of a recorder whose disk is full. When a block does not fit, the file is cut back to the last whole block,
// and every later block is refused.
//
// A block is handed to the kernel at once, so it survives the end of the process, but not a loss of power.
class RecordFile {
 public:
  RecordFile() = default;
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  // Replaces an existing file. False: error() says why.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool append(std::span<const std::byte> block);
  [[nodiscard]] bool close();  // false when any block, or the closing itself, failed

  bool is_open() const noexcept { return descriptor_ >= 0; }
  std::uint64_t size() const noexcept { return size_; }         // bytes of whole blocks
  std::uint32_t crc() const noexcept { return crc_.value(); }   // of all of them
  const std::string& error() const noexcept { return error_; }  // "PATH: why"; "" when there is no error

 private:
  bool fail(const char* what);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  Crc32 crc_;
  std::string error_;
};

// Compresses with zstd, in memory that it keeps from one use to the next.
class Packer {
 public:
  // `level`: of zstd, -7..19, less is faster. `largest`: bytes for whose packing there is room from the start.
  // Throws std::bad_alloc.
  explicit Packer(int level, std::size_t largest = 0);
  // Valid until the next call. Empty: zstd has failed.
  std::span<const std::byte> pack(std::span<const std::byte> bytes);

 private:
  struct ZstdDelete {
    void operator()(ZSTD_CCtx_s* context) const noexcept;
  };
  std::unique_ptr<ZSTD_CCtx_s, ZstdDelete> zstd_;
  std::vector<std::byte> packed_;
};

struct McapSettings {
  std::int64_t chunk_period_ns = 500'000'000;  // of log time
  std::size_t chunk_bytes = 1U << 19U;         // before compression
  int compression_level = -4;                  // as of a Packer; 0: not compressed
};

class McapWriter {
 public:
  explicit McapWriter(McapSettings settings = {});
  ~McapWriter();  // closes
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // Replaces an existing file. Call it once per writer.
  [[nodiscard]] bool open(const std::string& path);

  // May be called at any time after open(). Numbers count from 1; schema 0 means a channel without schema.
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view text);
  std::uint16_t add_channel(std::string_view topic, std::string_view encoding, std::uint16_t schema,
                            const TextMap& metadata = {});

  [[nodiscard]] bool write(std::uint16_t channel, std::uint32_t sequence, std::int64_t time_ns,
                           std::span<const std::byte> payload);
  [[nodiscard]] bool attach(const std::string& name, const std::string& media_type, std::int64_t time_ns,
                            std::span<const std::byte> data);
  [[nodiscard]] bool add_metadata(const std::string& name, const TextMap& values);

  [[nodiscard]] bool flush();  // ends the chunk now
  [[nodiscard]] bool close();  // false when any call since open() failed; a second close() does nothing

  bool is_open() const noexcept { return file_.is_open(); }
  const std::string& error() const noexcept { return file_.error(); }
  std::uint64_t file_bytes() const noexcept { return file_.size(); }
  std::uint64_t messages() const noexcept { return messages_; }  // messages written, those of the open chunk included

 private:
  struct Definition {  // where it stands among those for the summary
    std::size_t start = 0, length = 0;
    bool written = false;  // before its first message
  };
  struct Indexed {  // as it stands in the file
    std::uint64_t time_ns = 0, offset = 0;
  };
  struct Channel {
    std::uint16_t schema = 0;
    Definition definition;
    std::uint64_t messages = 0;
    std::vector<Indexed> index;  // of the open chunk
  };
  struct Chunk {  // the summary's data about the chunk that is being written
    std::uint64_t start_ns = 0, end_ns = 0, offset = 0, length = 0, index_length = 0, packed = 0, unpacked = 0;
    std::string_view compression;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;  // channel, offset in the file
  };

  bool chunk_is_due(std::uint64_t time_ns, std::size_t more) const noexcept;
  void put_once(Definition& definition, const ByteWriter& among);
  void put_chunk(Chunk& chunk);
  void put_message_indexes(Chunk& chunk);
  void keep_chunk_index(const Chunk& chunk);
  [[nodiscard]] bool append();
  void put_summary();
  void keep_statistics();

  McapSettings settings_;
  RecordFile file_;
  std::vector<Definition> schemas_;
  std::vector<Channel> channels_;
  std::optional<Packer> packer_;  // none: chunks are not compressed

  ByteWriter records_;  // of the open chunk
  ByteWriter block_;    // the bytes that go to the file in one piece
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0;

  std::uint64_t messages_ = 0, start_ns_ = 0, end_ns_ = 0;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
  // The records of the summary.
  ByteWriter schema_records_, channel_records_, statistics_, chunk_indexes_, attachment_indexes_, metadata_indexes_;
};

}  // namespace kadans
