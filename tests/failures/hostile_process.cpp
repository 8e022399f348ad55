// A process that plays no behaviors but does harm: hostile_process WHAT FINGERPRINT, started by ProcessHost.
//   mute      never answers             quit      dies at every request
//   nameless  begins with rubbish       hungry    takes memory until there is none
//   liar      answers, and each thing that it says is wrong in another way
//   scribble  writes anything anywhere in the shared memory, for ever, and rings
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "kadans/signal/random.h"
#include "realtime/machine/child_process.h"
#include "realtime/machine/placement.h"
#include "script/process/behavior_link.h"

using namespace kadans;

namespace {

struct Harm {
  BehaviorLink& link;
  Doorbell& bell;
  RandomStream random{0, "harm"};

  std::uint32_t number() { return link.request.number.given(); }
  void answer() { link.answer.number.give(number(), bell); }

  // Where counts and positions are.
  std::size_t start_of(std::size_t which) const {
    const std::array<const void*, 5> parts{&link.answer, &link.answer.kept, &link.answer.reply_size, &link.commands,
                                           &link.lines};
    return static_cast<std::size_t>(static_cast<const char*>(parts[which % 5]) - reinterpret_cast<const char*>(&link));
  }

  [[noreturn]] void scribble() {
    auto* const bytes = reinterpret_cast<volatile std::uint8_t*>(&link);
    for (;;) {
      for (int i = 0; i < 2000; ++i) {
        const std::uint64_t drawn = random.next();
        const auto spot = static_cast<std::size_t>(drawn >> 8);
        const std::size_t at = drawn % 4 == 0 ? start_of(spot) + (spot >> 8) % 192 : spot % (sizeof(BehaviorLink) - 8);
        for (std::size_t k = 0; k < 8; ++k)
          bytes[at + k] = static_cast<std::uint8_t>(drawn % 3 == 0 ? 0xff : drawn >> k);
      }
      answer();
    }
  }

  [[noreturn]] void eat() {
    (void)limit_memory(std::size_t{64} << 20U);
    for (std::vector<std::unique_ptr<char[]>> all;;) {
      all.push_back(std::make_unique<char[]>(1U << 20U));  // throws at last, and nobody catches it
      std::memset(all.back().get(), 1, 1U << 20U);
    }
  }

  Command odd_command() {
    const std::array<double, 5> values{std::nan(""), HUGE_VAL, -1e300, 0.1, 1e9};
    Command command;
    command.kind = static_cast<CommandKind>(random.next() % 12);
    command.index = random.next() % 2 == 0 ? static_cast<std::uint32_t>(random.next()) : random.next() % 8;
    command.count = static_cast<std::uint32_t>(random.next());
    command.value = values[random.next() % 5];
    command.duration_s = values[random.next() % 5];
    command.velocity = values[random.next() % 5];
    command.acceleration = values[random.next() % 5];
    return command;
  }

  // Whole transactions of commands that mean nothing; sometimes what is no transaction at all.
  void lie() {
    for (auto left = random.next() % 5; left > 0; --left) {
      std::vector<Command> batch(1 + random.next() % 20);
      for (Command& command : batch) command = odd_command();
      batch[0] = {.kind = CommandKind::transaction, .count = static_cast<std::uint32_t>(batch.size() - 1)};
      if (random.next() % 8 == 0) batch[0].count = static_cast<std::uint32_t>(random.next());
      (void)link.commands.try_push(batch);
    }
    const std::uint32_t size = random.next() % 4 == 0 ? 0xffffffffU : 3;
    const std::array<std::byte, 7> line{std::byte(size & 0xff),          std::byte(size >> 8 & 0xff),
                                        std::byte(size >> 16 & 0xff),    std::byte(size >> 24),
                                        std::byte(random.next() & 0xff), std::byte{1}};
    if (random.next() % 3 == 0) (void)link.lines.try_push(line);
    link.answer.kept_changed = static_cast<std::uint32_t>(random.next() % 2);
    link.answer.kept.size = static_cast<std::uint32_t>(random.next() % 3 == 0 ? random.next() : random.next() % 70000);
    link.answer.kept.hash = random.next();
    link.answer.reply_size = static_cast<std::uint32_t>(random.next() % 4 == 0 ? random.next() : random.next() % 200);
    for (std::size_t i = 0; i < 200; ++i)
      link.answer.replies[i] = std::byte(random.next() % 3 == 0 ? random.next() & 0xff : random.next() % 3);
    // As decisions: one order and no message, or anything.
    link.answer.decided_size = static_cast<std::uint32_t>(random.next() % 4 == 0 ? random.next() : random.next() % 64);
    for (std::size_t i = 0; i < 64; ++i)
      link.answer.decided[i] = std::byte(random.next() % 3 == 0 ? random.next() & 0xff : random.next() % 2);
    link.answer.told_size = static_cast<std::uint32_t>(random.next() % 8 == 0 ? random.next() : random.next() % 64);
    for (auto& numbers : link.answer.status) numbers.fill(static_cast<std::uint32_t>(random.next()));
    answer();
  }

  void at_request(const std::string& what) {
    random = RandomStream(number(), "harm");
    if (what == "quit") std::_Exit(3);
    if (what == "scribble") scribble();
    if (what == "hungry") eat();
    if (what == "liar") lie();
  }
};

}  // namespace

int main(int, char** arguments) {
  die_with_parent();
  const std::string what = arguments[1];
  const SharedMemory memory(child_memory_descriptor, sizeof(BehaviorLink));
  Doorbell bell(child_doorbell_descriptor);
  Harm harm{*static_cast<BehaviorLink*>(memory.get()), bell};
  BehaviorLink::Ready& ready = harm.link.ready;
  ready.fingerprint = std::strtoull(arguments[2], nullptr, 10);
  ready.count = what == "nameless" ? 1'000'000 : 1;
  std::strcpy(ready.names[0].data(), "harm");
  ready.is.give(1, bell);
  for (std::uint32_t done = 0; const auto number = harm.link.request.number.next(done, bell);) {
    done = *number;
    harm.at_request(what);
  }
  return 0;
}
