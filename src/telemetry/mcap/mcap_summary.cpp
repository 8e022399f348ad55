// The end of a record: DataEnd, the summary by which readers seek, and the footer.
#include <array>
#include <utility>

#include "mcap_record.h"
#include "mcap_writer.h"
#include "signal/crc32.h"

namespace kadans {

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
  using Group = std::pair<McapOpcode, void (McapWriter::*)()>;
  static constexpr std::array<Group, 6> groups{{{McapOpcode::schema, &McapWriter::put_schemas},
                                                {McapOpcode::channel, &McapWriter::put_channels},
                                                {McapOpcode::statistics, &McapWriter::put_statistics},
                                                {McapOpcode::chunk_index, &McapWriter::put_chunk_indexes},
                                                {McapOpcode::attachment_index, &McapWriter::put_attachment_indexes},
                                                {McapOpcode::metadata_index, &McapWriter::put_metadata_indexes}}};
  const std::uint64_t start = file_.size();
  ByteWriter offsets;
  for (const auto& [opcode, put_group] : groups) {
    const std::size_t group_start = block_.size();
    (this->*put_group)();
    if (block_.size() == group_start) continue;
    const McapRecord record(offsets, McapOpcode::summary_offset);
    offsets.put(static_cast<std::uint8_t>(opcode));
    offsets.put(start + group_start);
    offsets.put(static_cast<std::uint64_t>(block_.size() - group_start));
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

void McapWriter::put_schemas() {
  for (std::size_t i = 0; i < schemas_.size(); ++i) {
    const Schema& schema = schemas_[i];
    put_schema(block_, static_cast<std::uint16_t>(i + 1), schema.name, schema.encoding, schema.text);
  }
}

void McapWriter::put_channels() {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    put_channel(block_, static_cast<std::uint16_t>(i + 1), channel.schema, channel.topic, channel.encoding,
                channel.metadata);
  }
}

void McapWriter::put_statistics() {
  const McapRecord record(block_, McapOpcode::statistics);
  block_.put(messages_);
  block_.put(static_cast<std::uint16_t>(schemas_.size()));
  block_.put(static_cast<std::uint32_t>(channels_.size()));
  block_.put(static_cast<std::uint32_t>(attachments_.size()));
  block_.put(static_cast<std::uint32_t>(metadata_.size()));
  block_.put(chunks_);
  block_.put(start_ns_);
  block_.put(end_ns_);
  block_.put(static_cast<std::uint32_t>(channels_.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    block_.put(static_cast<std::uint16_t>(i + 1));
    block_.put(channels_[i].messages);
  }
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

void McapWriter::put_chunk_indexes() { block_.put(chunk_indexes_.bytes()); }

void McapWriter::put_attachment_indexes() {
  for (const Attachment& attachment : attachments_) {
    const McapRecord record(block_, McapOpcode::attachment_index);
    block_.put(attachment.offset);
    block_.put(attachment.length);
    block_.put(attachment.time_ns);
    block_.put(attachment.time_ns);
    block_.put(attachment.data_size);
    block_.put_string(attachment.name);
    block_.put_string(attachment.media_type);
  }
}

void McapWriter::put_metadata_indexes() {
  for (const Metadata& metadata : metadata_) {
    const McapRecord record(block_, McapOpcode::metadata_index);
    block_.put(metadata.offset);
    block_.put(metadata.length);
    block_.put_string(metadata.name);
  }
}

}  // namespace kadans
