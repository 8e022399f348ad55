#include "telemetry/mcap/mcap_writer.h"

#include <algorithm>
#include <csignal>
#include <cstring>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include "kadans/signal/random.h"
#include "scratch_file.h"
#include "telemetry/mcap/mcap_reader.h"

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;

struct Read {
  std::vector<std::uint32_t> sequences;
  bool complete = false;
  std::string problem;
};

Read read_all(const std::string& path) {
  Read read;
  McapReader reader(path);
  for (McapMessage message; reader.next(message);) read.sequences.push_back(message.sequence);
  read.complete = reader.complete();
  read.problem = reader.problem();
  return read;
}

// Two channels, a message on each every 10 ms; the bytes of the payloads come from a stream.
void write_run(McapWriter& writer, const std::string& path, std::uint32_t messages) {
  REQUIRE(writer.open(path));
  const auto schema = writer.add_schema("kadans_msgs/msg/A", "ros2msg", "float64 a\n");
  const auto a = writer.add_channel("/a", "cdr", schema, {{"unit", "rad"}});
  const auto b = writer.add_channel("/b", "json", 0);
  RandomStream random(1, "test");
  for (std::uint32_t i = 0; i < messages; ++i) {
    const std::uint64_t payload = random.next();
    const std::int64_t time_ns = std::int64_t{i / 2} * 10 * ms;
    REQUIRE(writer.write(i % 2 == 0 ? a : b, i, time_ns, std::as_bytes(std::span(&payload, 1))));
  }
}

// Where each chunk's record ends, and how many messages stand before that, by walking the opcodes.
struct ChunkEnd {
  std::size_t start = 0, offset = 0;
  std::size_t messages = 0;
};
std::vector<ChunkEnd> chunk_ends(const std::vector<std::byte>& file, std::size_t messages_per_chunk) {
  std::vector<ChunkEnd> ends;
  for (std::size_t at = mcap_magic.size(); at + mcap_record_head < file.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + at + 1, sizeof length);
    const auto opcode = static_cast<McapOpcode>(file[at]);
    const std::size_t start = at;
    at += mcap_record_head + static_cast<std::size_t>(length);
    if (opcode == McapOpcode::chunk) ends.push_back({start, at, (ends.size() + 1) * messages_per_chunk});
    if (opcode == McapOpcode::data_end) break;
  }
  return ends;
}

// While it stands, no file of this process grows beyond so many bytes: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit lower{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &lower);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("McapWriter: what is written is read back: topics, schemas, times, payloads, attachment and metadata") {
  const ScratchFile file;
  McapWriter writer;
  REQUIRE(writer.open(file.path()));
  const auto schema = writer.add_schema("kadans_msgs/msg/A", "ros2msg", "float64 a\n");
  const auto channel = writer.add_channel("/a", "cdr", schema, {{"unit", "rad"}});
  REQUIRE(writer.add_metadata("run", {{"seed", "7"}}));
  REQUIRE(writer.attach("tulip.urdf", "application/xml", 5, bytes_of("<robot/>")));
  REQUIRE(writer.write(channel, 3, 40 * ms, bytes_of("first")));
  REQUIRE(writer.write(channel, 4, 50 * ms, bytes_of("")));
  REQUIRE(writer.close());
  CHECK(writer.messages() == 2);

  McapReader reader(file.path());
  McapMessage message;
  REQUIRE(reader.next(message));
  CHECK(message.sequence == 3);
  CHECK(message.time_ns == 40 * ms);
  CHECK(std::ranges::equal(message.payload, bytes_of("first")));
  CHECK(reader.channels().at(message.channel) ==
        McapChannel{.topic = "/a", .encoding = "cdr", .schema = schema, .metadata = {{"unit", "rad"}}});
  CHECK(reader.schemas().at(schema) ==
        McapSchema{.name = "kadans_msgs/msg/A", .encoding = "ros2msg", .text = "float64 a\n"});
  REQUIRE(reader.next(message));
  CHECK(message.payload.empty());
  CHECK_FALSE(reader.next(message));
  CHECK(reader.complete());
  CHECK(reader.problem() == "");
  CHECK(reader.metadata().at("run").at("seed") == "7");
  REQUIRE(reader.attachments().size() == 1);
  CHECK(reader.attachments()[0].name == "tulip.urdf");
  CHECK(std::ranges::equal(reader.attachments()[0].data, bytes_of("<robot/>")));
}

TEST_CASE("McapWriter puts a chunk into the file when its time or its size is full, not before") {
  const ScratchFile file;
  McapWriter writer({.chunk_period_ns = 100 * ms, .chunk_bytes = 1000, .compression_level = 0});
  REQUIRE(writer.open(file.path()));
  const auto channel = writer.add_channel("/a", "json", 0);
  const std::string payload(300, ' ');
  const std::uint64_t empty = writer.file_bytes();
  REQUIRE(writer.write(channel, 0, 0, bytes_of("{}")));
  REQUIRE(writer.write(channel, 1, 99 * ms, bytes_of("{}")));
  CHECK(writer.file_bytes() == empty);
  REQUIRE(writer.write(channel, 2, 100 * ms, bytes_of(payload)));
  const std::uint64_t one_chunk = writer.file_bytes();
  CHECK(one_chunk > empty);
  REQUIRE(writer.write(channel, 3, 100 * ms, bytes_of(payload)));
  CHECK(writer.file_bytes() == one_chunk);
  REQUIRE(writer.write(channel, 4, 100 * ms, bytes_of(payload)));  // 993 bytes
  CHECK(writer.file_bytes() == one_chunk);
  REQUIRE(writer.write(channel, 5, 100 * ms, bytes_of("{}")));
  CHECK(writer.file_bytes() > one_chunk);
}

TEST_CASE("McapWriter: a file cut anywhere streams every message of the chunks before the cut") {
  const ScratchFile file;
  constexpr std::uint32_t messages = 1000;  // 10 ms apart in pairs: 100 to a second, two chunks a second
  {
    McapWriter writer;
    write_run(writer, file.path(), messages);
    REQUIRE(writer.close());
  }
  const std::vector<std::byte> whole = file.bytes();
  const std::vector<ChunkEnd> ends = chunk_ends(whole, 100);
  REQUIRE(ends.size() == 10);
  RandomStream random(2, "cuts");
  for (int i = 0; i < 20; ++i) {
    const auto cut = static_cast<std::size_t>(random.uniform(40, static_cast<double>(whole.size())));
    const ScratchFile part;
    part.write(std::span(whole).first(cut));
    std::size_t expected = 0;
    for (const ChunkEnd& end : ends) {
      if (end.offset <= cut) expected = end.messages;
    }
    const Read read = read_all(part.path());
    INFO("cut at ", cut, " of ", whole.size());
    CHECK(read.sequences.size() == expected);
    CHECK(std::ranges::is_sorted(read.sequences));
    CHECK_FALSE(read.complete);
    CHECK(read.problem.find("the file ends") != std::string::npos);
  }
}

TEST_CASE("McapWriter: a schema and a channel stand once in front of their first message, and in the summary") {
  const ScratchFile file;
  McapWriter writer({.compression_level = 0});
  REQUIRE(writer.open(file.path()));
  const auto schema = writer.add_schema("sample.Schema", "jsonschema", "{}");
  const auto channel = writer.add_channel("/sample", "json", schema);
  for (std::uint32_t i = 0; i < 100; ++i) {
    REQUIRE(writer.write(channel, i, i * 10 * ms, bytes_of("{}")));
    REQUIRE(writer.flush());
  }
  REQUIRE(writer.close());
  CHECK(read_all(file.path()).sequences.size() == 100);
  const std::vector<std::byte> whole = file.bytes();
  const auto times = [&](std::string_view text) {
    const auto wanted = bytes_of(text);
    std::size_t count = 0;
    for (auto at = whole.begin();; ++at, ++count) {
      at = std::search(at, whole.end(), wanted.begin(), wanted.end());
      if (at == whole.end()) return count;
    }
  };
  CHECK(times("sample.Schema") == 2);
  CHECK(times("/sample") == 2);
}

TEST_CASE("McapWriter: a file nobody closed reads up to the last whole chunk") {
  const ScratchFile file;
  McapWriter writer;
  write_run(writer, file.path(), 1000);
  const Read read = read_all(file.path());  // as after a kill: the last chunk is still in memory
  CHECK(read.sequences.size() == 900);
  CHECK(read.problem.find("ends without a footer") != std::string::npos);
}

TEST_CASE("McapWriter makes the same bytes of the same calls") {
  const ScratchFile first, second;
  for (const ScratchFile* file : {&first, &second}) {
    McapWriter writer;
    write_run(writer, file->path(), 300);
    REQUIRE(writer.close());
  }
  CHECK(first.bytes() == second.bytes());
  CHECK(first.bytes().size() > 1000);
}

TEST_CASE("McapWriter: a full disk is reported with the file's name and refuses what comes after") {
  McapWriter writer;
  CHECK_FALSE(writer.open("/dev/full"));
  CHECK(writer.error() == "/dev/full: cannot write the record: No space left on device");
  const auto channel = writer.add_channel("/a", "json", 0);
  CHECK_FALSE(writer.write(channel, 0, 0, bytes_of("{}")));
  CHECK_FALSE(writer.flush());
  CHECK_FALSE(writer.close());
  CHECK_FALSE(writer.close());
}

TEST_CASE("McapWriter: when the disk fills up in the middle, the file keeps its whole chunks and nothing else") {
  const ScratchFile file;
  McapWriter writer({.chunk_bytes = 10'000, .compression_level = 0});
  REQUIRE(writer.open(file.path()));
  const auto channel = writer.add_channel("/a", "json", 0);
  const std::string payload(1000, ' ');
  std::uint32_t accepted = 0;
  bool flushed = false, attached = false;
  {
    const FileSizeLimit limit(100'000);
    while (accepted < 1000 && writer.write(channel, accepted, accepted, bytes_of(payload))) ++accepted;
    flushed = writer.flush();
    attached = writer.attach("a", "text/plain", 0, bytes_of("small enough to fit"));
  }
  CHECK_FALSE(flushed);
  CHECK_FALSE(attached);
  CHECK_FALSE(writer.close());
  CHECK(writer.error() == file.path() + ": cannot write the record: File too large");
  CHECK(accepted == 99);  // nine to a chunk; the eleventh chunk was refused
  CHECK(file.bytes().size() == writer.file_bytes());
  CHECK(read_all(file.path()).sequences.size() == 90);
  CHECK(read_all(file.path()).problem.find("the file ends without a footer") != std::string::npos);
}

TEST_CASE("McapWriter: a folder that is not there is reported when opening") {
  McapWriter writer;
  CHECK_FALSE(writer.open("/nonexistent/run.mcap"));
  CHECK(writer.error() == "/nonexistent/run.mcap: cannot create the record: No such file or directory");
}

TEST_CASE("McapWriter refuses messages of channels it does not know") {
  const ScratchFile file;
  McapWriter writer;
  REQUIRE(writer.open(file.path()));
  CHECK_FALSE(writer.write(0, 0, 0, bytes_of("")));
  CHECK_FALSE(writer.write(1, 0, 0, bytes_of("")));
  CHECK(writer.error() == "");
}
