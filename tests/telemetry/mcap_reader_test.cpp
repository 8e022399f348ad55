#include "telemetry/mcap/mcap_reader.h"

#include <doctest/doctest.h>
#include <zstd.h>

#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "scratch_file.h"
#include "signal/crc32.h"
#include "telemetry/mcap/mcap_writer.h"

using namespace kadans;

namespace {

void put_record(ByteWriter& to, McapOpcode opcode, std::span<const std::byte> body) {
  to.put(static_cast<std::uint8_t>(opcode));
  to.put(static_cast<std::uint64_t>(body.size()));
  to.put(body);
}

void put_chunk(ByteWriter& to, std::string_view compression, std::uint64_t size, std::uint32_t crc,
               std::span<const std::byte> packed) {
  ByteWriter body;
  body.put(std::uint64_t{0});
  body.put(std::uint64_t{0});
  body.put(size);
  body.put(crc);
  body.put_string(compression);
  body.put(static_cast<std::uint64_t>(packed.size()));
  body.put(packed);
  put_record(to, McapOpcode::chunk, body.bytes());
}

void put_channel(ByteWriter& to, std::uint16_t schema, std::string_view topic) {
  ByteWriter body;
  body.put(std::uint16_t{1});
  body.put(schema);
  body.put_string(topic);
  body.put_string("json");
  body.put_map({});
  put_record(to, McapOpcode::channel, body.bytes());
}

// What the reader says of a file that holds the magic and then whatever `fill` puts there.
template <typename Fill>
std::string problem_of(Fill fill) {
  ByteWriter bytes;
  bytes.put(bytes_of(mcap_magic));
  fill(bytes);
  const ScratchFile file;
  file.write(bytes.bytes());
  McapReader reader(file.path());
  for (McapMessage message; reader.next(message);) {
  }
  CHECK_FALSE(reader.complete());
  const std::string prefix = file.path() + ": ";
  return reader.problem().substr(0, prefix.size()) == prefix ? reader.problem().substr(prefix.size()) : "no file name";
}

std::vector<std::byte> zip_bomb(std::size_t size) {
  const std::vector<std::byte> zeros(size);
  std::vector<std::byte> packed(ZSTD_compressBound(size));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), zeros.data(), zeros.size(), 1));
  return packed;
}

}  // namespace

TEST_CASE("McapReader refuses what is not there or no MCAP file, with its name") {
  CHECK_THROWS_WITH_AS(McapReader("/nonexistent.mcap"), "/nonexistent.mcap: there is no such file", InputError);
  CHECK_THROWS_AS(McapReader("/"), InputError);
  const ScratchFile file;
  file.write(bytes_of("\x89MCAP1\r\n"));
  CHECK_THROWS_AS(McapReader(file.path()), InputError);
  file.write({});
  CHECK_THROWS_AS(McapReader(file.path()), InputError);
}

TEST_CASE("McapReader stops at a length beyond the file") {
  CHECK(problem_of([](ByteWriter& to) {
          to.put(std::uint8_t{6});
          to.put(std::uint64_t{0xffffffffffffffff});
        }) == "byte 8: the file ends in a record of 18446744073709551615 bytes");
  CHECK(problem_of([](ByteWriter& to) { to.put(std::uint32_t{6}); }) == "byte 8: the file ends in a record");
}

TEST_CASE("McapReader stops at a length beyond the record") {
  CHECK(problem_of([](ByteWriter& to) {
          ByteWriter body;
          body.put(std::uint16_t{1});
          body.put(std::uint16_t{0});
          body.put(std::uint32_t{0xffffffff});
          put_record(to, McapOpcode::channel, body.bytes());
        }) == "byte 8: a channel that is malformed");
  CHECK(problem_of([](ByteWriter& to) { put_record(to, McapOpcode::chunk, bytes_of("too short")); }) ==
        "byte 8: a chunk that is malformed");
  CHECK(problem_of([](ByteWriter& to) { put_record(to, McapOpcode::attachment, bytes_of("too short")); }) ==
        "byte 8: an attachment that is malformed");
}

TEST_CASE("McapReader does not unpack a zip bomb, whatever size it claims") {
  const auto packed = zip_bomb(100U << 20U);
  CHECK(packed.size() < 20'000);
  CHECK(problem_of([&](ByteWriter& to) { put_chunk(to, "zstd", 100U << 20U, 0, packed); }) ==
        "byte 8: a chunk of 104857600 bytes, more than 67108864 are not unpacked");
  CHECK(problem_of([&](ByteWriter& to) { put_chunk(to, "zstd", 1000, 0, packed); }) ==
        "byte 8: a chunk that does not unpack: Destination buffer is too small");
  CHECK(problem_of([&](ByteWriter& to) { put_chunk(to, "zstd", ~std::uint64_t{0}, 0, packed); }).find("more than") !=
        std::string::npos);
}

TEST_CASE("McapReader stops at a chunk that is damaged, of another size than it says or packed another way") {
  CHECK(problem_of([](ByteWriter& to) {
          put_chunk(to, "zstd", 10, 0, bytes_of("no zstd frame"));
        }).find("does not unpack") != std::string::npos);
  CHECK(problem_of([](ByteWriter& to) { put_chunk(to, "", 10, 0, bytes_of("short")); }) ==
        "byte 8: a chunk whose size is not what it says");
  CHECK(problem_of([](ByteWriter& to) { put_chunk(to, "", 5, 1, bytes_of("wrong")); }) ==
        "byte 8: a chunk with the wrong CRC");
  CHECK(problem_of([](ByteWriter& to) { put_chunk(to, "lz4", 5, 0, bytes_of("")); }) ==
        "byte 8: a chunk compressed with 'lz4', which is not read");
}

TEST_CASE("McapReader stops at messages and channels that point nowhere, and at definitions that change") {
  CHECK(problem_of([](ByteWriter& to) { put_channel(to, 3, "/a"); }) == "byte 8: channel /a has the unknown schema 3");
  CHECK(problem_of([](ByteWriter& to) { put_record(to, McapOpcode::message, std::vector<std::byte>(22)); }) ==
        "byte 8: a message of the unknown channel 0");
  CHECK(problem_of([](ByteWriter& to) { put_record(to, McapOpcode::message, std::vector<std::byte>(21)); }) ==
        "byte 8: a message that is malformed");
  CHECK(problem_of([](ByteWriter& to) {
          put_channel(to, 0, "/a");
          put_channel(to, 0, "/b");
        }).find("channel 1 changes") != std::string::npos);
}

TEST_CASE("McapReader reads messages outside chunks and passes over records it does not know") {
  ByteWriter bytes;
  bytes.put(bytes_of(mcap_magic));
  put_record(bytes, static_cast<McapOpcode>(0x80), bytes_of("private"));
  put_channel(bytes, 0, "/a");
  ByteWriter body;
  body.put(std::uint16_t{1});
  body.put(std::uint32_t{9});
  body.put(std::uint64_t{5});
  body.put(std::uint64_t{5});
  body.put(bytes_of("{}"));
  put_record(bytes, McapOpcode::message, body.bytes());
  const ScratchFile file;
  file.write(bytes.bytes());
  McapReader reader(file.path());
  McapMessage message;
  REQUIRE(reader.next(message));
  CHECK(message.sequence == 9);
  CHECK(message.time_ns == 5);
  CHECK(message.payload.size() == 2);
}

TEST_CASE("McapReader survives 300 records with bytes changed at random") {
  const ScratchFile file;
  {
    McapWriter writer({.chunk_period_ns = 10, .compression_level = 0});
    REQUIRE(writer.open(file.path()));
    const auto schema = writer.add_schema("a", "jsonschema", "{}");
    const auto channel = writer.add_channel("/a", "json", schema, {{"unit", "rad"}});
    REQUIRE(writer.attach("a", "text/plain", 0, bytes_of("attached")));
    REQUIRE(writer.add_metadata("run", {{"seed", "1"}}));
    for (std::uint32_t i = 0; i < 20; ++i) REQUIRE(writer.write(channel, i, i, bytes_of("{}")));
    REQUIRE(writer.close());
  }
  const std::vector<std::byte> good = file.bytes();
  RandomStream random(3, "damage");
  std::size_t read_whole = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<std::byte> bad = good;
    for (int i = 0; i < 3; ++i) {
      bad[mcap_magic.size() + random.next() % (bad.size() - mcap_magic.size())] = static_cast<std::byte>(random.next());
    }
    file.write(bad);
    McapReader reader(file.path());
    for (McapMessage message; reader.next(message);) {
    }
    if (reader.complete()) ++read_whole;
    if (!reader.complete()) REQUIRE(reader.problem() != "");
  }
  CHECK(read_whole < 225);  // damage to the summary, which a streaming reader passes over, goes unseen
}
