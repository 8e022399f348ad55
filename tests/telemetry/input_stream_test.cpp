// The inputs of a run in its record: read as they were written, and never believed when they are damaged.
#include "telemetry/record/input_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "telemetry/record/recorded_inputs.h"
#include "telemetry/record/run_inputs.h"

namespace input_stream_test {

using namespace kadans;

namespace {

constexpr InputLayout layout{.joints = 2, .feet = 1, .channels = 1, .down = 2};
constexpr std::size_t signals = 3, kinds = 8;

// Ticks of a run: words that stand still, count, are noise, signals, an encoder's positions, near to a signal of two
// ticks ago, or count unevenly, all alike.
struct Ticks final : SignalBits {
  std::vector<std::vector<std::uint64_t>> words;
  std::vector<std::vector<double>> rows;
  std::uint64_t first = 0;

  Ticks(std::size_t count, std::uint64_t from) : first(from) {
    RandomStream random(7, "inputs");
    std::int64_t place = -12;                       // it passes zero, from both sides
    constexpr double step = 9.587379924285257e-05;  // of an encoder
    std::uint64_t uneven = 0;
    for (std::size_t t = 0; t < count; ++t) {
      std::vector<std::uint64_t>& tick = words.emplace_back(layout.words());
      std::vector<double>& row = rows.emplace_back(signals);
      for (double& value : row) value = random.uniform(-1, 1);
      uneven += random.next() % 3;
      for (std::size_t w = 0; w < tick.size(); ++w) {
        const std::size_t kind = w % kinds;
        if (kind == 1) tick[w] = 1000 + 3 * t;
        if (kind == 2) tick[w] = random.next();
        if (kind == 3) tick[w] = std::bit_cast<std::uint64_t>(row[w % signals]);
        if (kind == 4) tick[w] = t < count / 2 ? 5 : std::numeric_limits<std::uint64_t>::max();
        if (kind == 5) {
          const std::int64_t change = 3 - 2 * static_cast<std::int64_t>(t % 4);
          place += change;
          const double value = static_cast<double>(place) * step;
          tick[w] = std::bit_cast<std::uint64_t>(place == 0 && change > 0 ? -value : value);
        }
        if (kind == 6) tick[w] = std::bit_cast<std::uint64_t>(rows[t < 2 ? t : t - 2][w % signals]) + t % 5;
        if (kind == 7) tick[w] = uneven + 1000 * w;
      }
    }
  }
  std::optional<std::uint64_t> bits(std::uint64_t tick, std::uint32_t signal) const override {
    if (tick < first || tick - first >= rows.size() || signal >= signals) return std::nullopt;
    return std::bit_cast<std::uint64_t>(rows[tick - first][signal]);
  }
  static std::int64_t time_ns(std::size_t t) { return static_cast<std::int64_t>(t * 1'000'000 + t % 7); }
};

std::vector<std::byte> message_of(InputEncoder& encoder) {
  ByteWriter message;
  encoder.encode(message);
  return {message.bytes().begin(), message.bytes().end()};
}

std::vector<std::vector<std::byte>> messages_of(const Ticks& ticks) {
  InputEncoder encoder(layout, {true, true, true});
  std::vector<std::vector<std::byte>> messages;
  for (std::size_t t = 0; t < ticks.words.size(); ++t) {
    if (encoder.full()) messages.push_back(message_of(encoder));
    REQUIRE(encoder.add(ticks.first + t, Ticks::time_ns(t), ticks.words[t], ticks.rows[t]));
  }
  messages.push_back(message_of(encoder));
  return messages;
}

// False: an event is damaged or missing.
bool read_all(std::span<const std::byte> bytes, std::vector<BehaviorInput>& all) {
  ByteReader reader(bytes);
  std::uint32_t expected = 0;
  while (reader.left() > 0) {
    BehaviorInput input;
    if (!take_behavior_input(reader, expected, input)) return false;
    all.push_back(std::move(input));
  }
  return true;
}

void check_same(const TickTaken& read, const std::vector<std::uint64_t>& words) {
  CHECK(read.words == words);
  TickTaken expected;
  unpack(words, layout, expected);
  CHECK(std::bit_cast<std::uint64_t>(read.inputs.dt_s) == std::bit_cast<std::uint64_t>(expected.inputs.dt_s));
  CHECK(read.inputs.heartbeat_ns == expected.inputs.heartbeat_ns);
  CHECK(read.inputs.commands == expected.inputs.commands);
  CHECK(read.stopped_by == expected.stopped_by);
  CHECK(read.down == expected.down);
  CHECK(read.sensors.time_ns == expected.sensors.time_ns);
  for (std::size_t i = 0; i < layout.joints; ++i) {
    const JointSample &a = read.sensors.joints[i], &b = expected.sensors.joints[i];
    CHECK(std::bit_cast<std::uint64_t>(a.position_rad) == std::bit_cast<std::uint64_t>(b.position_rad));
    CHECK(std::bit_cast<std::uint64_t>(a.motor_effort_Nm) == std::bit_cast<std::uint64_t>(b.motor_effort_Nm));
    CHECK(a.sequence == b.sequence);
    CHECK(a.time_ns == b.time_ns);
    CHECK(a.drive == b.drive);
  }
  CHECK(read.sensors.channels[0].sequence == expected.sensors.channels[0].sequence);
}

}  // namespace

TEST_CASE("Inputs of ticks are read with the bits with which they were written, from any first tick on") {
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{1} << 33U}) {
    const Ticks ticks(250, first);
    InputDecoder decoder(layout);
    std::deque<TickTaken> read;
    for (const std::vector<std::byte>& message : messages_of(ticks)) REQUIRE(decoder.decode(message, ticks, read));
    REQUIRE(read.size() == ticks.words.size());
    for (std::size_t t = 0; t < read.size(); ++t) {
      CHECK(read[t].tick == first + t);
      CHECK(read[t].time_ns == Ticks::time_ns(t));
      check_same(read[t], ticks.words[t]);
    }
  }
}

TEST_CASE("Each message of a flight record is read without the messages before it") {
  InputLayout alone = layout;
  alone.state_bytes = 100;
  const Ticks ticks(250, 1000);
  InputEncoder encoder(alone, {});
  std::vector<std::vector<std::byte>> messages;
  for (std::size_t t = 0; t < 250; ++t) {
    if (encoder.full() || t == 130) messages.push_back(message_of(encoder));
    REQUIRE(encoder.add(1000 + t, Ticks::time_ns(t), ticks.words[t], {}));
  }
  REQUIRE(messages.size() == 3);
  for (const std::size_t which : {2U, 0U, 1U}) {
    InputDecoder decoder(alone);
    std::deque<TickTaken> read;
    CHECK(messages[which].size() <= InputEncoder::bytes_max(alone));
    REQUIRE(decoder.decode(messages[which], ticks, read));
    for (const TickTaken& tick : read) check_same(tick, ticks.words[tick.tick - 1000]);
    CHECK(read.front().tick == std::array{1000, 1100, 1130}[which]);
  }
  CHECK(InputLayout::of(alone.facts())->state_bytes == 100);
}

TEST_CASE(
    "Inputs that stand still, count or are signals take some bytes a message, encoders and near ones one a tick") {
  const Ticks ticks(300, 0);
  std::size_t noisy = 0;
  for (std::size_t w = 0; w < layout.words(); ++w) noisy += w % kinds == 2 ? 1U : 0U;
  const std::vector<std::vector<std::byte>> messages = messages_of(ticks);
  REQUIRE(messages.size() == 3);
  // Noise takes eight bytes a tick; an encoder, what is near to a signal, and the first that counts unevenly one.
  CHECK(messages.back().size() < 100 * (8 + 1 + 1) * (noisy + 1) + 24 * layout.words());
}

TEST_CASE("An encoder around zero takes a byte a tick, whichever zero it reads first") {
  constexpr InputLayout one{.joints = 1};
  constexpr double step = 9.587379924285257e-05;
  RandomStream random(5, "zero");
  InputEncoder encoder(one, {});
  ByteWriter message;
  for (std::uint64_t t = 0; t < 300; ++t) {
    if (encoder.full()) encoder.encode(message);
    std::vector<std::uint64_t> words(one.words());
    const double count = t < 100 ? -0.0 : std::round(random.uniform(-1.5, 1.5));  // both zeros, and then their sides
    words.back() = std::bit_cast<std::uint64_t>(random.next() % 2 == 0 ? count * step : (count + 0.0) * step);
    REQUIRE(encoder.add(t, static_cast<std::int64_t>(t), words, {}));
  }
  encoder.encode(message);
  CHECK(message.size() < 700);  // three messages of 100 ticks; one of doubles alone takes 800
}

TEST_CASE("Damaged inputs are refused, or read as other values of the same types, and nothing else happens") {
  const Ticks ticks(200, 0);
  const std::vector<std::vector<std::byte>> messages = messages_of(ticks);
  RandomStream random(11, "damage");
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::vector<std::byte>& whole = messages.at(static_cast<std::size_t>(i) % messages.size());
    std::vector<std::byte> damaged = whole;
    if (i % 3 == 0) damaged.resize(random.next() % whole.size());
    for (int k = 0; k < 1 + i % 4 && !damaged.empty(); ++k)
      damaged[random.next() % (i % 2 == 0 ? damaged.size() : std::min<std::size_t>(damaged.size(), 40))] =
          static_cast<std::byte>(random.next());
    InputDecoder decoder(layout);
    std::deque<TickTaken> read;
    if (!decoder.decode(damaged, ticks, read)) ++refused;
    for (const TickTaken& taken : read) {
      CHECK(taken.sensors.joint_count <= layout.joints);
      CHECK(taken.sensors.foot_count <= layout.feet);
      CHECK(static_cast<int>(taken.sensors.joints[1].drive) <= static_cast<int>(DriveState::fault));
    }
  }
  CHECK(refused > 1000);
  CHECK_FALSE(InputLayout::of({{"format", "2"}, {"joints", "5000"}, {"feet", "1"}, {"channels", "0"}, {"down", "0"}}));
  CHECK_FALSE(InputLayout::of({{"format", "1"}, {"joints", "2"}, {"feet", "1"}, {"channels", "0"}, {"down", "0"}}));
}

TEST_CASE("A flight record gets commands and what is handed down, a record the rest, and both notice what is missing") {
  RecordedInputs inputs("/project");
  std::vector<std::byte> value(5003);
  for (std::size_t i = 0; i < value.size(); i += i < 400 ? 3 : 900) value[i] = static_cast<std::byte>(i + 1);
  const std::array<Command, 2> batch{Command{.kind = CommandKind::transaction, .count = 1, .sequence = 3},
                                     Command{.kind = CommandKind::clear_faults}};
  inputs.tick_begins({}, 0);
  inputs.handed_down(4, 77, value);
  inputs.sent(batch, true);
  inputs.handed_down(4, 78, {});
  inputs.tick_ends();
  ByteWriter message, record, flight;
  inputs.take(message);
  EventSorter sorter;
  sorter.sort(message.bytes(), &record, &flight);
  std::vector<BehaviorInput> recorded, flown;
  REQUIRE(read_all(record.bytes(), recorded));
  REQUIRE(read_all(flight.bytes(), flown));
  REQUIRE(recorded.size() == 3);
  CHECK(recorded[1].kind == BehaviorInput::Kind::sent);
  REQUIRE(flown.size() == 3);
  CHECK(flown[0].number == 4);
  CHECK(flown[0].handed == 77);
  CHECK(flown[0].bytes == value);
  CHECK(flown[1].commands.size() == 2);
  CHECK(flown[2].bytes.empty());
  CHECK(flight.size() < 1500);  // zeros take next to nothing

  ByteWriter lost;
  inputs.tick_begins({}, 0);
  inputs.take(lost);
  lost.clear();
  inputs.sent(batch, true);
  inputs.take(lost);
  record.clear();
  flight.clear();
  sorter.sort(lost.bytes(), &record, &flight);
  CHECK(number_of_behavior_input(ByteReader(record.bytes())) == 4);  // 3 is missing
  CHECK(number_of_behavior_input(ByteReader(flight.bytes())) == 4);

  RandomStream random(13, "damage");
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> damaged(message.bytes().begin(), message.bytes().end());
    damaged[random.next() % damaged.size()] = static_cast<std::byte>(random.next());
    if (i % 2 == 0) damaged.resize(random.next() % damaged.size());
    std::vector<BehaviorInput> some;
    (void)read_all(damaged, some);
    EventSorter().sort(damaged, &record, &flight);
  }
}

TEST_CASE("A saved state is read as it was written, and a cut one is refused") {
  const std::vector<std::int64_t> numbers{5, -7};
  const std::vector<std::byte> bytes(100, std::byte{3});
  ByteWriter message;
  put_state({41, numbers, bytes}, message);
  std::vector<std::int64_t> found;
  EngineStates::Saved saved;
  REQUIRE(take_state(message.bytes(), found, saved));
  CHECK(saved.tick == 41);
  CHECK(std::ranges::equal(saved.found, numbers));
  CHECK(std::ranges::equal(saved.bytes, bytes));
  for (std::size_t size = 0; size < 28; ++size) CHECK_FALSE(take_state(message.bytes().first(size), found, saved));
}

TEST_CASE("What the behavior thread took is read in its order, damage and a missing event are noticed") {
  RecordedInputs inputs("/project");
  Snapshot snapshot;
  snapshot.tick = 41;
  snapshot.time_ns = 42'000'000;
  inputs.file_read("/project/behaviors/a.lua", "return 1");
  inputs.file_read("/project/behaviors/a.lua", "return 1");  // known by now
  inputs.tick_begins(snapshot, 43'000'000);
  CHECK(inputs.parameter(0.1) == 0.1);
  const std::array<Command, 2> batch{Command{.kind = CommandKind::transaction, .count = 1, .sequence = 3},
                                     Command{.kind = CommandKind::set_point, .index = 4, .value = 0.5}};
  inputs.sent(batch, true);
  CHECK(inputs.time_is_over([](void*) noexcept { return true; }, nullptr));
  inputs.tick_ends();
  ByteWriter message;
  inputs.take(message);
  std::vector<BehaviorInput> all;
  REQUIRE(read_all(message.bytes(), all));
  REQUIRE(all.size() == 6);
  CHECK(all[0].path == "behaviors/a.lua");
  CHECK(all[0].text == "return 1");
  CHECK(all[1].snapshot == 42);
  CHECK(all[2].value == 0.1);
  CHECK(all[3].in_tick);
  REQUIRE(all[3].commands.size() == 2);
  CHECK(all[3].commands[1].value == 0.5);
  CHECK(all[4].number == 1);
  CHECK(all[5].kind == BehaviorInput::Kind::tick_ends);

  RecordedInputs secretive("/project", {"behaviors/secret*"});
  secretive.file_read("/project/behaviors/secret_walk.lua", "return 1");
  ByteWriter secret;
  secretive.take(secret);
  std::vector<BehaviorInput> hashed;
  REQUIRE(read_all(secret.bytes(), hashed));
  CHECK(hashed.at(0).kind == BehaviorInput::Kind::private_file);
  CHECK(hashed[0].path == "behaviors/secret_walk.lua");
  CHECK(hashed[0].text == content_hash("return 1"));

  RandomStream random(13, "damage");
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> damaged(message.bytes().begin(), message.bytes().end());
    damaged[random.next() % damaged.size()] = static_cast<std::byte>(random.next());
    if (i % 2 == 0) damaged.resize(random.next() % damaged.size());
    std::vector<BehaviorInput> some;
    (void)read_all(damaged, some);
    CHECK(some.size() <= all.size());
  }
  const std::size_t first = 8 + 1 + 4 + 15 + 4 + 8;  // head, kind, and two texts with their lengths
  std::vector<BehaviorInput> rest;
  CHECK_FALSE(read_all(message.bytes().subspan(first), rest));
}

TEST_CASE("What another process took is passed on, also from the next one, and what is missing or rubbish is noticed") {
  using Kind = BehaviorInput::Kind;
  using Asked = BehaviorInputs::Asked;
  const auto told = [](RecordedInputs& by, double parameter) {
    by.file_read("/project/behaviors/a.lua", "return 1");
    (void)by.parameter(parameter);
    by.asked(Asked::decided, {});
    ByteWriter bytes;
    by.take(bytes);
    return std::vector<std::byte>(bytes.bytes().begin(), bytes.bytes().end());
  };
  RecordedInputs one("/project"), next("/project"), record("/project");
  const std::vector<std::byte> first = told(one, 0.5), second = told(one, 0.6), third = told(one, 0.7),
                               anew = told(next, 0.8);
  const auto read = [&record](std::vector<BehaviorInput>& all) {
    ByteWriter message;
    record.take(message);
    return read_all(message.bytes(), all);
  };
  record.tick_begins({}, 0);
  for (const auto* bytes : {&first, &second, &anew}) CHECK(record.pass_on(*bytes));
  record.tick_ends();
  std::vector<BehaviorInput> all;
  REQUIRE(read(all));
  REQUIRE(all.size() == 9);  // the file once
  CHECK(all[1].path == "behaviors/a.lua");
  CHECK(all[2].value == 0.5);
  CHECK(all[3].how == Asked::decided);
  CHECK(all[4].value == 0.6);
  CHECK(all[6].value == 0.8);
  CHECK(record.pass_on(third));  // of a process that is gone: its numbers do not go on from the last one's
  record.tick_begins({}, 0);
  ByteWriter gap;
  record.take(gap);
  CHECK(number_of_behavior_input(ByteReader(gap.bytes())) == 10);

  RecordedInputs liar("/project");
  liar.tick_begins({}, 0);  // of another process that is the record's own to tell
  ByteWriter lie;
  liar.take(lie);
  CHECK_FALSE(record.pass_on(lie.bytes()));
  liar.file_read(std::string(5000, 'a'), "");
  lie.clear();
  liar.take(lie);
  CHECK_FALSE(record.pass_on(lie.bytes()));

  RandomStream random(13, "rubbish");
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> damaged = first;
    damaged[random.next() % damaged.size()] = static_cast<std::byte>(random.next());
    if (i % 2 == 0) damaged.resize(random.next() % damaged.size());
    RecordedInputs fresh("/project");
    (void)fresh.pass_on(damaged);
    ByteWriter message;
    fresh.take(message);
    std::vector<BehaviorInput> some;
    (void)read_all(message.bytes(), some);
    for (const BehaviorInput& input : some) {
      const bool may = input.kind == Kind::file || input.kind == Kind::private_file || input.kind == Kind::parameter ||
                       input.kind == Kind::time_over || input.kind == Kind::asked;
      CHECK(may);
    }
  }
}

}  // namespace input_stream_test
