// The bytes of LBP16 and the registers of HostMot2, each side against what is known of them, without the other side.
#include <cmath>

#include <doctest/doctest.h>

#include "hostmot2_bench.h"
#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"
#include "plant/hostmot2/emulator/emulated_wire.h"
#include "plant/hostmot2/encoder.h"
#include "plant/hostmot2/lbp_link.h"

namespace kadans::hostmot2 {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Card {
  explicit Card(const EmulatedBoard::Settings& settings = {}) : board(settings), responder(board) {}
  Bytes ask(const Bytes& datagram) { return responder.answer(datagram); }
  std::uint32_t read(unsigned address) {
    std::uint32_t value = 0;
    CHECK(board.read(address, value));
    return value;
  }
  EmulatedBoard board;
  Lbp16Responder responder;
};

// What the other end sends and receives, by hand.
class PaperPort final : public DatagramPort {
 public:
  struct Sheet {
    std::vector<Bytes> sent, replies;
    std::int64_t now = 0;
  };
  explicit PaperPort(Sheet& sheet) : sheet_(sheet) {}
  bool send(Octets datagram) noexcept override {
    sheet_.sent.emplace_back(datagram.begin(), datagram.end());
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t) noexcept override {
    if (sheet_.replies.empty()) return 0;
    const Bytes bytes = sheet_.replies.front();
    sheet_.replies.erase(sheet_.replies.begin());
    std::copy_n(bytes.begin(), std::min(bytes.size(), into.size()), into.begin());
    return bytes.size();
  }
  void await(std::int64_t until_ns) noexcept override { sheet_.now = until_ns; }
  std::int64_t now_ns() const noexcept override { return sheet_.now; }

 private:
  Sheet& sheet_;
};

struct Paper {
  PaperPort::Sheet sheet;
  LbpLink link{std::make_unique<PaperPort>(sheet), 1'000'000, 0};
  std::array<std::uint32_t, 2> words{};
  BoardLink::Sample sample;

  Paper() {
    link.lay_out({.reads = {{0x3000, 2}}, .writes = {{0x0E00, 1}}, .rare_writes = {{0x3100, 2}}});
    sheet.sent.clear();
  }
  void ask() { link.send(std::array<std::uint32_t, 1>{0x5A000000}); }
  // An answer to request `number`, from a board that had the writes of `heard` before.
  static Bytes answer(std::uint8_t number, std::uint8_t heard) {
    return {number, 0, 0, 0, 1, 0, 2, 0, 3, 0, 4, 0, number, 0, 0, 0, heard, 0, 0, 0};
  }
  bool get(const Bytes& reply) {
    sheet.replies.push_back(reply);
    return link.collect(words, sample);
  }
};

}  // namespace

TEST_CASE("A tick's datagram has the bytes of LBP16") {
  Paper paper;
  paper.ask();
  CHECK(paper.sheet.sent.at(0) == Bytes{0x82, 0xD1, 0x10, 0x00, 1,    0,    0,    0,     // the request's number
                                        0x82, 0x51, 0x10, 0x00,                          // read back
                                        0x82, 0x42, 0x00, 0x30,                          // two words from 0x3000
                                        0x84, 0x51, 0x10, 0x00,                          // both numbers
                                        0x81, 0xC2, 0x00, 0x0E, 0x00, 0x00, 0x00, 0x5A,  // the watchdog's cookie
                                        0x82, 0xD1, 0x14, 0x00, 1,    0,    0,    0});   // the writes' number
  paper.link.send(std::array<std::uint32_t, 3>{0x5A000000, 0x0858, 0x0800});
  CHECK(paper.sheet.sent.at(1) == Bytes{0x82, 0xD1, 0x10, 0x00, 2,    0,    0,    0,                       //
                                        0x82, 0x51, 0x10, 0x00,                                            //
                                        0x82, 0x42, 0x00, 0x30,                                            //
                                        0x84, 0x51, 0x10, 0x00,                                            //
                                        0x81, 0xC2, 0x00, 0x0E, 0x00, 0x00, 0x00, 0x5A,                    //
                                        0x82, 0xC2, 0x00, 0x31, 0x58, 0x08, 0,    0,    0x00, 0x08, 0, 0,  // latches
                                        0x82, 0xD1, 0x14, 0x00, 2,    0,    0,    0});
  CHECK(paper.link.reply_bytes() == 20);
}

TEST_CASE("An answer is taken once, by its number, and each that is not is counted for what it is") {
  Paper paper;
  const LinkCounts& counts = paper.link.counts();
  for (int i = 0; i < 3; ++i) paper.ask();
  CHECK(paper.get(Paper::answer(3, 2)));
  CHECK(paper.words == std::array<std::uint32_t, 2>{0x20001, 0x40003});
  CHECK(paper.sample.number == 3);
  CHECK(counts.lost == 2);     // 1 and 2 never came
  CHECK(counts.unheard == 0);  // the board had them
  CHECK_FALSE(paper.get(Paper::answer(2, 1)));
  CHECK(counts.reordered == 1);
  CHECK(counts.lost == 1);
  CHECK_FALSE(paper.get(Paper::answer(3, 2)));
  CHECK(counts.duplicates == 1);
  paper.ask();
  paper.ask();
  CHECK(paper.get(Paper::answer(4, 3)));  // of the request before the last
  CHECK(counts.late == 1);
  CHECK(paper.get(Paper::answer(5, 4)));
  CHECK(counts.late == 1);
  paper.ask();
  paper.ask();
  CHECK(paper.get(Paper::answer(7, 5)));  // 6 did not reach the board
  CHECK(counts.unheard == 1);
  CHECK_FALSE(paper.sample.forgot);
  CHECK_FALSE(paper.get(Paper::answer(9, 7)));  // of a request that nobody made
  Bytes bent = Paper::answer(7, 5);
  bent.pop_back();
  CHECK_FALSE(paper.get(bent));
  CHECK_FALSE(paper.get(Bytes(2000)));
  bent = Paper::answer(8, 7);
  bent[12] = 7;  // its two numbers differ
  paper.ask();
  CHECK_FALSE(paper.get(bent));
  CHECK(counts.refused == 4);
  CHECK(counts.short_ == 2);
  CHECK(paper.get(Paper::answer(8, 0)));
  CHECK(paper.sample.forgot);  // its scratch memory is as after its power came on
}

TEST_CASE("A tick of a link does not allocate") {
  class StillPort final : public DatagramPort {
   public:
    bool send(Octets datagram) noexcept override {
      std::copy_n(datagram.begin() + 4, 4, number_.begin());
      return asked_ = true;
    }
    std::size_t receive(std::span<std::uint8_t> into, std::int64_t) noexcept override {
      if (!std::exchange(asked_, false)) return 0;
      std::copy_n(number_.begin(), 4, into.begin());
      std::copy_n(number_.begin(), 4, into.begin() + 12);
      std::copy_n(number_.begin(), 4, into.begin() + 16);
      --into[16];
      return 20;
    }
    void await(std::int64_t until_ns) noexcept override { now_ = until_ns; }
    std::int64_t now_ns() const noexcept override { return now_; }

   private:
    std::array<std::uint8_t, 4> number_{};
    bool asked_ = false;
    std::int64_t now_ = 0;
  };
  LbpLink link(std::make_unique<StillPort>(), 1'000'000, 0);
  const std::array<std::uint32_t, 1> pet{0x5A000000};
  bool good = true;
  std::array<std::uint32_t, 2> words{};
  BoardLink::Sample sample;
  link.lay_out({.reads = {{0x3000, 2}}, .writes = {{0x0E00, 1}}, .rare_writes = {}});
  const testing::AllocationCount heap;
  for (int i = 0; i < 200; ++i) {
    link.send(pet);
    good = good && link.collect(words, sample);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(good);
}

TEST_CASE("An emulated board answers the first bytes that masters send, and keeps silent on what is wrong") {
  Card card;
  const Bytes its_cookie{0xFE, 0xCA, 0xAA, 0x55};
  CHECK(card.ask({0x81, 0x42, 0x00, 0x01}) == its_cookie);
  CHECK(card.ask({0x01, 0x42, 0x00, 0x01}) == its_cookie);  // without increment
  const Bytes name{'7', 'I', '9', '6', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  CHECK(card.ask({0x88, 0x5D, 0x00, 0x00}) == name);
  CHECK(card.ask({0x83, 0x49, 0x02, 0x00}).size() == 6);  // the MAC
  Bytes info = card.ask({0x88, 0x61, 0x00, 0x00});
  REQUIRE(info.size() == 16);
  info.erase(info.begin() + 6, info.begin() + 8);  // the pointer, wherever it is
  CHECK(info == Bytes{0x00, 0x5A, 0x04, 0x81, 0x10, 0x00, 'H', 'o', 's', 't', 'M', 'o', 't', '2'});
  CHECK(card.ask({0x82, 0xD1, 0x10, 0x00, 1, 2, 3, 4}).empty());  // a write has no reply
  CHECK(card.ask({0x84, 0x51, 0x10, 0x00}) == Bytes{1, 2, 3, 4, 0, 0, 0, 0});
  CHECK(card.ask({0x01, 0x42, 0x00, 0x01, 0x01, 0x02}).size() == 8);                  // the space's own pointer
  for (const Bytes& wrong : {Bytes{0x80, 0x42, 0x00, 0x01},                           // none of them
                             Bytes{0x81}, Bytes{0x81, 0x42, 0x00},                    // cut
                             Bytes{0x81, 0xC2, 0x00, 0x01, 0, 0, 0},                  // data missing
                             Bytes{0x81, 0x40, 0x00, 0x01},                           // 8 bits of registers
                             Bytes{0x81, 0x42, 0x02, 0x01},                           // not aligned
                             Bytes{0x81, 0x55, 0x00, 0x00},                           // space 5
                             Bytes{0x81, 0x42, 0x00, 0x01, 0x81, 0x42, 0x02, 0x01}})  // a good one before it
    CHECK(card.ask(wrong).empty());
  CHECK(card.responder.not_understood() == 8);
  CHECK(card.ask({0x01, 0x59, 0x0C, 0x00}) == Bytes{8, 0});  // it counted them
}

TEST_CASE("The watchdog makes all pins inputs, and leaves the rest") {
  Card card;
  const unsigned pin = 20;
  (void)card.ask({0x81, 0xC2, 0x04, 0x11, 0x08, 0, 0, 0});  // the second port's pin 3 is an output
  (void)card.ask({0x81, 0xC2, 0x04, 0x10, 0x08, 0, 0, 0});  // and high
  CHECK(card.board.level(pin) == 1);
  card.board.pass(1'000'000'000);
  CHECK_FALSE(card.board.bitten());                               // disabled at first
  (void)card.ask({0x81, 0xC2, 0x00, 0x0C, 0x9F, 0x86, 0x01, 0});  // 99999: 1 ms
  for (int i = 0; i < 10; ++i) {
    card.board.pass(900'000);
    (void)card.ask({0x81, 0xC2, 0x00, 0x0E, 0, 0, 0, 0x5A});
  }
  CHECK_FALSE(card.board.bitten());
  card.board.pass(900'000);
  (void)card.ask({0x81, 0xC2, 0x00, 0x0E, 0, 0, 0, 0x5B});  // another cookie does nothing
  card.board.pass(100'000);
  CHECK(card.board.bitten());
  CHECK(card.read(0x0D00) == 1);
  CHECK(card.read(0x1104) == 0);
  CHECK(card.board.level(pin) == 0);
  (void)card.ask({0x81, 0xC2, 0x00, 0x0E, 0, 0, 0, 0x5A});
  CHECK(card.read(0x0D00) == 1);
  (void)card.ask({0x81, 0xC2, 0x00, 0x0D, 0, 0, 0, 0});
  CHECK(card.read(0x0D00) == 0);
  (void)card.ask({0x81, 0xC2, 0x04, 0x11, 0x08, 0, 0, 0});
  CHECK(card.board.level(pin) == 1);  // the output's register was kept
}

TEST_CASE("Counts wrap at 16 bits, have the time of their change, and are latched at the index") {
  Card card;
  (void)card.ask({0x81, 0xC2, 0x00, 0x32, 48, 0, 0, 0});  // 2 MHz of time stamps
  card.board.pass(1'000'000);
  card.board.turn_to(1, 40'000);
  CHECK(card.read(0x3004) == (2000U << 16U | 40'000));
  card.board.pass(1'000'000);
  CHECK(card.read(0x3004) == (2000U << 16U | 40'000));
  CHECK(card.read(0x3300) == 4000);
  card.board.turn_to(1, 70'000);
  CHECK((card.read(0x3004) & 0xFFFFU) == 70'000 - 65'536);
  card.board.turn_to(1, 71'990);
  (void)card.ask({0x81, 0xC2, 0x04, 0x31, 0x58, 0x08, 0, 0});  // latch on index, once
  CHECK((card.read(0x3104) & 0x50U) == 0x50);
  card.board.turn_to(1, 72'020);
  CHECK((card.read(0x3104) >> 16U) == 72'000 - 65'536);
  CHECK((card.read(0x3104) & 0x10U) == 0);
  card.board.turn_to(1, 76'001);
  CHECK((card.read(0x3104) >> 16U) == 72'000 - 65'536);
  (void)card.ask({0x81, 0xC2, 0x04, 0x30, 0, 0, 0, 0});  // a write clears the count
  CHECK((card.read(0x3004) & 0xFFFFU) == 0);
}

TEST_CASE("A PWM's two lines are those of its output type, and need rate, enable, direction and source") {
  Card card;
  const auto levels = [&] { return std::pair{card.board.level(3), card.board.level(4)}; };
  const auto write = [&](unsigned address, std::uint32_t value) { CHECK(card.board.write(address, value)); };
  write(0x4004, 0x0400U << 16U | 0x80000000U);  // a quarter of 12 bits, backwards
  write(0x4104, 0x23);                          // 12 bits, double buffer
  write(0x4200, 26'843);
  write(0x1100, 0x38);
  write(0x1200, 0x38);
  CHECK(levels() == std::pair{0.0, 1.0});  // not enabled
  write(0x4400, 2);
  CHECK(levels() == std::pair{0.25, 1.0});
  CHECK(card.board.level(5) == 0);  // its /ENABLE
  write(0x4104, 0x2B);
  CHECK(levels() == std::pair{1.0, 0.25});
  write(0x4104, 0x33);
  CHECK(levels() == std::pair{0.25, 0.0});
  write(0x4004, 0x0400U << 16U);
  CHECK(levels() == std::pair{0.0, 0.25});
  write(0x4104, 0x1B);  // pulses of their own rate
  CHECK(levels() == std::pair{0.0, 0.0});
  write(0x4300, 1966);
  CHECK(levels() == std::pair{0.25, 0.0});
  write(0x1200, 0);
  CHECK(levels() == std::pair{0.0, 0.0});
}

TEST_CASE("An encoder's velocity is that of its time stamps, however slow it turns") {
  Encoder encoder(2e6);
  const auto word = [](std::uint32_t stamp, std::uint32_t count) { return stamp << 16U | (count & 0xFFFFU); };
  encoder.take(word(0, 65'530), 0, 0);
  CHECK(encoder.count() == -6);
  encoder.take(word(1000, 65'534), 2000, 1e-3);
  encoder.take(word(3000, 2), 4000, 1e-3);  // past the end of 16 bits: 4 counts in 2000 stamps
  CHECK(encoder.count() == 2);
  CHECK(encoder.counts_per_s() == doctest::Approx(4000));
  for (std::uint32_t clock = 6000; clock <= 40'000; clock += 2000) encoder.take(word(3000, 2), clock, 1e-3);
  CHECK(encoder.counts_per_s() == doctest::Approx(1 / 18.5e-3));  // not one count in all that time
  encoder.take(word(41'000, 1), 42'000, 1e-3);
  CHECK(encoder.counts_per_s() == doctest::Approx(-1 / 19e-3));
  encoder.take(word(42'500, 2), 44'000, 1e-3);
  CHECK(encoder.counts_per_s() == 0);  // one there, one back
  for (int i = 0; i < 600; ++i) encoder.take(word(42'500, 2), 44'000 + 2000U * static_cast<unsigned>(i + 1), 1e-3);
  CHECK(encoder.counts_per_s() == 0);
  CHECK(encoder.extended(65'535) == -1);
}

TEST_CASE("An emulated board bears whatever is sent to it") {
  Card card;
  RandomStream random(7, "hostile");
  for (int i = 0; i < bench::hostile_count(); ++i) {
    Bytes datagram(random.next() % 200);
    for (std::uint8_t& byte : datagram) byte = static_cast<std::uint8_t>(random.next());
    const Bytes reply = card.ask(datagram);
    CHECK_MESSAGE(reply.size() <= 1472, i);
    card.board.pass(1000);
    for (unsigned pin = 0; pin < card.board.pins(); pin += 7) {
      const double level = card.board.level(pin);
      if (!(level >= 0 && level <= 1)) FAIL_CHECK(level);
    }
  }
  CHECK(card.responder.not_understood() > 1000);
}

}  // namespace kadans::hostmot2
