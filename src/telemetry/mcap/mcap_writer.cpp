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

void McapWriter::ZstdDelete::operator()(ZSTD_CCtx_s* context) const noexcept { ZSTD_freeCCtx(context); }

McapWriter::McapWriter(McapSettings settings) : settings_(settings) {
  if (settings_.compression_level == 0) return;
  zstd_.reset(ZSTD_createCCtx());
  if (zstd_ == nullptr) return;
  const auto set = [this](ZSTD_cParameter parameter, int value) {
    (void)ZSTD_CCtx_setParameter(zstd_.get(), parameter, value);
  };
  set(ZSTD_c_compressionLevel, settings_.compression_level);
  if (settings_.compression_level > 0) return;
  set(ZSTD_c_minMatch, 7);  // numbers of eight bytes: shorter matches cost time and save little
  set(ZSTD_c_hashLog, 12);  // the last rows alone, in the nearest cache
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

std::uint16_t McapWriter::add_schema(std::string name, std::string encoding, std::string text) {
  schemas_.push_back({.name = std::move(name), .encoding = std::move(encoding), .text = std::move(text)});
  return static_cast<std::uint16_t>(schemas_.size());
}

std::uint16_t McapWriter::add_channel(std::string topic, std::string encoding, std::uint16_t schema, TextMap metadata) {
  Channel channel;
  channel.topic = std::move(topic);
  channel.encoding = std::move(encoding);
  channel.schema = schema;
  channel.metadata = std::move(metadata);
  channels_.push_back(std::move(channel));
  return static_cast<std::uint16_t>(channels_.size());
}

bool McapWriter::chunk_is_due(std::uint64_t time_ns, std::size_t more) const noexcept {
  if (records_.size() == 0) return false;
  const std::uint64_t span_ns = std::max(time_ns, chunk_end_ns_) - std::min(time_ns, chunk_start_ns_);
  return span_ns >= static_cast<std::uint64_t>(settings_.chunk_period_ns) ||
         records_.size() + more > settings_.chunk_bytes;
}

void McapWriter::put_definitions(std::uint16_t channel) {
  Channel& of = channels_[channel - 1U];
  if (std::exchange(of.written, true)) return;
  if (of.schema != 0 && !std::exchange(schemas_[of.schema - 1U].written, true)) {
    const Schema& schema = schemas_[of.schema - 1U];
    put_schema(records_, of.schema, schema.name, schema.encoding, schema.text);
  }
  put_channel(records_, channel, of.schema, of.topic, of.encoding, of.metadata);
}

bool McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::int64_t time_ns,
                       std::span<const std::byte> payload) {
  if (!file_.is_open() || !error().empty() || channel == 0 || channel > channels_.size()) return false;
  const auto log_time_ns = static_cast<std::uint64_t>(time_ns);
  if (chunk_is_due(log_time_ns, message_head + payload.size()) && !flush()) return false;
  const bool first = records_.size() == 0;
  chunk_start_ns_ = first ? log_time_ns : std::min(chunk_start_ns_, log_time_ns);
  chunk_end_ns_ = first ? log_time_ns : std::max(chunk_end_ns_, log_time_ns);
  put_definitions(channel);

  Channel& to = channels_[channel - 1U];
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

// Appends the chunk's records to the block, compressed. False: nothing was appended.
bool McapWriter::pack() {
  if (zstd_ == nullptr) return false;
  packed_.resize(std::max(packed_.size(), ZSTD_compressBound(records_.size())));
  const std::size_t size =
      ZSTD_compress2(zstd_.get(), packed_.data(), packed_.size(), records_.bytes().data(), records_.size());
  if (ZSTD_isError(size) != 0) return false;  // out of memory
  block_.put(std::span(packed_).first(size));
  return true;
}

void McapWriter::put_chunk(Chunk& chunk) {
  chunk.start_ns = chunk_start_ns_;
  chunk.end_ns = chunk_end_ns_;
  chunk.offset = file_.size();
  chunk.unpacked = records_.size();
  {
    const McapRecord record(block_, McapOpcode::chunk);
    block_.put(chunk.start_ns);
    block_.put(chunk.end_ns);
    block_.put(chunk.unpacked);
    block_.put(crc32(records_.bytes()));
    const std::size_t at = block_.size();
    chunk.compression = "zstd";
    block_.put_string(chunk.compression);
    block_.put(std::uint64_t{0});
    const std::size_t start = block_.size();
    if (pack()) {
      chunk.packed = block_.size() - start;
      block_.set(start - sizeof(std::uint64_t), chunk.packed);
    } else {
      chunk.compression = "";
      chunk.packed = chunk.unpacked;
      block_.shrink(at);
      block_.put_string(chunk.compression);
      block_.put(chunk.packed);
      block_.put(records_.bytes());
    }
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
  Attachment index{.offset = file_.size(),
                   .time_ns = static_cast<std::uint64_t>(time_ns),
                   .data_size = data.size(),
                   .name = name,
                   .media_type = media_type};
  {
    const McapRecord record(block_, McapOpcode::attachment);
    block_.put(index.time_ns);
    block_.put(index.time_ns);  // created when logged
    block_.put_string(name);
    block_.put_string(media_type);
    block_.put(index.data_size);
    block_.put(data);
    block_.put(crc32(block_.bytes().subspan(mcap_record_head)));
  }
  index.length = block_.size();
  if (!append()) return false;
  attachments_.push_back(std::move(index));
  return true;
}

bool McapWriter::add_metadata(const std::string& name, const TextMap& values) {
  Metadata index{.offset = file_.size(), .name = name};
  {
    const McapRecord record(block_, McapOpcode::metadata);
    block_.put_string(name);
    block_.put_map(values);
  }
  index.length = block_.size();
  if (!append()) return false;
  metadata_.push_back(std::move(index));
  return true;
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
