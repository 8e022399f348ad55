#include "mcap_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include "mcap_format.h"

namespace kadans {
namespace {

constexpr std::size_t message_head = mcap_record_head + 22;  // record head, channel, sequence, two times
constexpr std::size_t definitions_bytes = std::size_t{64} << 10U;

}  // namespace

void Packer::ZstdDelete::operator()(ZSTD_CCtx_s* context) const noexcept { ZSTD_freeCCtx(context); }

Packer::Packer(int level, std::size_t largest) : zstd_(ZSTD_createCCtx()), packed_(ZSTD_compressBound(largest)) {
  if (zstd_ == nullptr) throw std::bad_alloc();
  const auto set = [this](ZSTD_cParameter parameter, int value) {
    (void)ZSTD_CCtx_setParameter(zstd_.get(), parameter, value);
  };
  set(ZSTD_c_compressionLevel, level);
  if (level > 0) return;
  set(ZSTD_c_minMatch, 7);  // numbers of eight bytes: shorter matches cost time and save little
  set(ZSTD_c_hashLog, 12);  // the last rows alone, in the nearest cache
}

std::span<const std::byte> Packer::pack(std::span<const std::byte> bytes) {
  packed_.resize(std::max(packed_.size(), ZSTD_compressBound(bytes.size())));
  const std::size_t size = ZSTD_compress2(zstd_.get(), packed_.data(), packed_.size(), bytes.data(), bytes.size());
  return std::span(packed_).first(ZSTD_isError(size) != 0 ? 0 : size);
}

McapWriter::McapWriter(McapSettings settings) : settings_(settings) {
  if (settings_.compression_level != 0) packer_.emplace(settings_.compression_level);
}

McapWriter::~McapWriter() { (void)close(); }

bool McapWriter::open(const std::string& path) {
  if (!file_.open(path)) return false;
  records_.reserve(settings_.chunk_bytes + definitions_bytes);  // else it may grow to twice of that
  block_.clear();
  block_.put(bytes_of(mcap_magic));
  {
    const McapRecord record(block_, McapOpcode::header);
    block_.put_string("");  // profile: none
    block_.put_string("kadans");
  }
  return append();
}

bool McapWriter::append() {
  const bool appended = file_.append(block_.bytes());
  block_.clear();
  return appended;
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding, std::string_view text) {
  const std::size_t start = schema_records_.size();
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  {
    const McapRecord record(schema_records_, McapOpcode::schema);
    schema_records_.put(id);
    schema_records_.put_string(name);
    schema_records_.put_string(encoding);
    schema_records_.put_string(text);
  }
  schemas_.push_back({.start = start, .length = schema_records_.size() - start});
  return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::string_view encoding, std::uint16_t schema,
                                      const TextMap& metadata) {
  const std::size_t start = channel_records_.size();
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  {
    const McapRecord record(channel_records_, McapOpcode::channel);
    channel_records_.put(id);
    channel_records_.put(schema);
    channel_records_.put_string(topic);
    channel_records_.put_string(encoding);
    channel_records_.put_map(metadata);
  }
  channels_.push_back(
      {.schema = schema, .definition = {.start = start, .length = channel_records_.size() - start}, .index = {}});
  return id;
}

bool McapWriter::chunk_is_due(std::uint64_t time_ns, std::size_t more) const noexcept {
  if (records_.size() == 0) return false;
  const std::uint64_t span_ns = std::max(time_ns, chunk_end_ns_) - std::min(time_ns, chunk_start_ns_);
  return span_ns >= static_cast<std::uint64_t>(settings_.chunk_period_ns) ||
         records_.size() + more > settings_.chunk_bytes;
}

void McapWriter::put_once(Definition& definition, const ByteWriter& among) {
  if (!std::exchange(definition.written, true))
    records_.put(among.bytes().subspan(definition.start, definition.length));
}

bool McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::int64_t time_ns,
                       std::span<const std::byte> payload) {
  if (!file_.is_open() || !error().empty() || channel == 0 || channel > channels_.size()) return false;
  const auto log_time_ns = static_cast<std::uint64_t>(time_ns);
  if (chunk_is_due(log_time_ns, message_head + payload.size()) && !flush()) return false;
  const bool first = records_.size() == 0;
  chunk_start_ns_ = first ? log_time_ns : std::min(chunk_start_ns_, log_time_ns);
  chunk_end_ns_ = first ? log_time_ns : std::max(chunk_end_ns_, log_time_ns);
  Channel& to = channels_[channel - 1U];
  if (to.schema != 0) put_once(schemas_[to.schema - 1U], schema_records_);
  put_once(to.definition, channel_records_);
  to.index.push_back({log_time_ns, records_.size()});
  std::array<std::byte, message_head> head{};  // at once: there are thousands a second
  std::byte* at = head.data();
  const auto put = [&at](const auto& value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  };
  put(McapOpcode::message);
  put(static_cast<std::uint64_t>(message_head - mcap_record_head + payload.size()));
  put(channel);
  put(sequence);
  put(log_time_ns);
  put(log_time_ns);  // published when logged
  records_.put(head);
  records_.put(payload);
  start_ns_ = messages_ == 0 ? log_time_ns : std::min(start_ns_, log_time_ns);
  end_ns_ = std::max(end_ns_, log_time_ns);
  ++to.messages;
  ++messages_;
  return true;
}

void McapWriter::put_chunk(Chunk& chunk) {
  chunk.start_ns = chunk_start_ns_;
  chunk.end_ns = chunk_end_ns_;
  chunk.offset = file_.size();
  chunk.unpacked = records_.size();
  std::span<const std::byte> packed;
  if (packer_) packed = packer_->pack(records_.bytes());
  if (!packed.empty()) chunk.compression = "zstd";
  if (packed.empty()) packed = records_.bytes();
  chunk.packed = packed.size();
  {
    const McapRecord record(block_, McapOpcode::chunk);
    block_.put(chunk.start_ns);
    block_.put(chunk.end_ns);
    block_.put(chunk.unpacked);
    block_.put(crc32(records_.bytes()));
    block_.put_string(chunk.compression);
    block_.put(chunk.packed);
    block_.put(packed);
  }
  chunk.length = block_.size();
}

void McapWriter::put_message_indexes(Chunk& chunk) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].index.empty()) continue;
    const auto channel = static_cast<std::uint16_t>(i + 1);
    chunk.indexes.emplace_back(channel, chunk.offset + block_.size());
    const McapRecord record(block_, McapOpcode::message_index);
    block_.put(channel);
    const std::span<const std::byte> index = std::as_bytes(std::span(channels_[i].index));
    block_.put(static_cast<std::uint32_t>(index.size()));
    block_.put(index);
    channels_[i].index.clear();
  }
  chunk.index_length = block_.size() - chunk.length;
}

bool McapWriter::flush() {
  if (records_.size() == 0) return error().empty();
  Chunk chunk;
  put_chunk(chunk);
  put_message_indexes(chunk);
  records_.clear();
  if (!append()) return false;
  keep_chunk_index(chunk);
  return true;
}

bool McapWriter::attach(const std::string& name, const std::string& media_type, std::int64_t time_ns,
                        std::span<const std::byte> data) {
  const std::uint64_t offset = file_.size(), logged_ns = static_cast<std::uint64_t>(time_ns), size = data.size();
  {
    const McapRecord record(block_, McapOpcode::attachment);
    block_.put(logged_ns);
    block_.put(logged_ns);  // created when logged
    block_.put_string(name);
    block_.put_string(media_type);
    block_.put(size);
    block_.put(data);
    block_.put(crc32(block_.bytes().subspan(mcap_record_head)));
  }
  const std::uint64_t length = block_.size();
  if (!append()) return false;
  const McapRecord record(attachment_indexes_, McapOpcode::attachment_index);
  attachment_indexes_.put(offset);
  attachment_indexes_.put(length);
  attachment_indexes_.put(logged_ns);
  attachment_indexes_.put(logged_ns);
  attachment_indexes_.put(size);
  attachment_indexes_.put_string(name);
  attachment_indexes_.put_string(media_type);
  ++attachments_;
  return true;
}

bool McapWriter::add_metadata(const std::string& name, const TextMap& values) {
  const std::uint64_t offset = file_.size();
  {
    const McapRecord record(block_, McapOpcode::metadata);
    block_.put_string(name);
    block_.put_map(values);
  }
  const std::uint64_t length = block_.size();
  if (!append()) return false;
  const McapRecord record(metadata_indexes_, McapOpcode::metadata_index);
  metadata_indexes_.put(offset);
  metadata_indexes_.put(length);
  metadata_indexes_.put_string(name);
  ++metadata_;
  return true;
}

void McapWriter::keep_chunk_index(const Chunk& chunk) {
  const McapRecord record(chunk_indexes_, McapOpcode::chunk_index);
  chunk_indexes_.put(chunk.start_ns);
  chunk_indexes_.put(chunk.end_ns);
  chunk_indexes_.put(chunk.offset);
  chunk_indexes_.put(chunk.length);
  chunk_indexes_.put(
      static_cast<std::uint32_t>(chunk.indexes.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
  for (const auto& [channel, offset] : chunk.indexes) {
    chunk_indexes_.put(channel);
    chunk_indexes_.put(offset);
  }
  chunk_indexes_.put(chunk.index_length);
  chunk_indexes_.put_string(chunk.compression);
  chunk_indexes_.put(chunk.packed);
  chunk_indexes_.put(chunk.unpacked);
  ++chunks_;
}

void McapWriter::keep_statistics() {
  const McapRecord record(statistics_, McapOpcode::statistics);
  statistics_.put(messages_);
  statistics_.put(static_cast<std::uint16_t>(schemas_.size()));
  statistics_.put(static_cast<std::uint32_t>(channels_.size()));
  statistics_.put(attachments_);
  statistics_.put(metadata_);
  statistics_.put(chunks_);
  statistics_.put(start_ns_);
  statistics_.put(end_ns_);
  statistics_.put(static_cast<std::uint32_t>(channels_.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    statistics_.put(static_cast<std::uint16_t>(i + 1));
    statistics_.put(channels_[i].messages);
  }
}

bool McapWriter::close() {
  if (!file_.is_open()) return error().empty();
  if (flush()) {
    {
      const McapRecord record(block_, McapOpcode::data_end);
      block_.put(file_.crc());
    }
    if (append()) {
      put_summary();
      (void)append();
    }
  }
  return file_.close();
}

void McapWriter::put_summary() {
  keep_statistics();
  const std::array<std::pair<McapOpcode, const ByteWriter*>, 6> groups{
      {{McapOpcode::schema, &schema_records_},
       {McapOpcode::channel, &channel_records_},
       {McapOpcode::statistics, &statistics_},
       {McapOpcode::chunk_index, &chunk_indexes_},
       {McapOpcode::attachment_index, &attachment_indexes_},
       {McapOpcode::metadata_index, &metadata_indexes_}}};
  const std::uint64_t start = file_.size();
  ByteWriter offsets;
  for (const auto& [opcode, records] : groups) {
    if (records->size() == 0) continue;
    const McapRecord record(offsets, McapOpcode::summary_offset);
    offsets.put(static_cast<std::uint8_t>(opcode));
    offsets.put(start + block_.size());
    offsets.put(static_cast<std::uint64_t>(records->size()));
    block_.put(records->bytes());
  }
  const std::uint64_t offsets_start = start + block_.size();
  block_.put(offsets.bytes());

  // By hand, because the CRC covers the footer's own opcode, length and first two fields.
  block_.put(static_cast<std::uint8_t>(McapOpcode::footer));
  block_.put(static_cast<std::uint64_t>(2 * sizeof(std::uint64_t) + sizeof(std::uint32_t)));
  block_.put(start);
  block_.put(offsets_start);
  block_.put(crc32(block_.bytes()));
  block_.put(bytes_of(mcap_magic));
}

static_assert(sizeof(off_t) == 8, "records may pass 2 GB on 32-bit machines too");

RecordFile::~RecordFile() {
  if (is_open()) ::close(descriptor_);
}

bool RecordFile::fail(const char* what) {
  const std::string reason = std::generic_category().message(errno);
  if (error_.empty()) error_ = path_ + ": " + what + ": " + reason;
  return false;
}

bool RecordFile::open(const std::string& path) {
  if (is_open()) ::close(descriptor_);
  path_ = path;
  size_ = 0;
  crc_ = Crc32{};
  error_.clear();
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0644);
  return is_open() || fail("cannot create the record");
}

bool RecordFile::append(std::span<const std::byte> block) {
  if (!is_open() || !error_.empty()) return false;
  for (std::span<const std::byte> left = block; !left.empty();) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const bool failed = fail("cannot write the record");
      // Half a block is of no use. A device or pipe cannot be cut; its reader copes with a record that ends early.
      (void)(::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0);
      return failed;
    }
    left = left.subspan(static_cast<std::size_t>(written));
  }
  size_ += block.size();
  crc_.add(block);
  return true;
}

bool RecordFile::close() {
  if (!is_open()) return error_.empty();
  const bool closed = ::close(descriptor_) == 0;
  descriptor_ = -1;
  if (!closed) return fail("cannot close the record");
  return error_.empty();
}

}  // namespace kadans
