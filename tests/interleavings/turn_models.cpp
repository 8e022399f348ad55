// The memory shared with the process that plays behaviors: requests and answers by their numbers, commands and lines in
// rings, a bell. As ProcessHost and BehaviorServer use it, over the same templates.
#include <array>
#include <memory>

#include "checker.h"
#include "kadans/exchange/ring.h"
#include "kadans/exchange/turn.h"

namespace kadans::interleavings {
namespace {

// Wakes whenever it likes, and orders nothing: what is handed over may not depend on it.
struct DeafBell {
  enum class Heard { nothing, ring, end };
  void ring() const noexcept {}
  Heard wait(std::int64_t) {
    look_again();
    return Heard::nothing;
  }
};

// Wakes for a ring and for nothing else; a ring that is missing leaves both sides waiting for ever.
class TrueBell {
 public:
  enum class Heard { nothing, ring, end };
  TrueBell() : rings_(rl::ctx().sema_ctor(false, 0, 1000)) {}
  ~TrueBell() { rl::ctx().sema_dtor(rings_); }
  TrueBell(const TrueBell&) = delete;
  TrueBell& operator=(const TrueBell&) = delete;

  void ring() {
    unsigned before = 0;
    (void)rings_->post(1, before, RL_INFO);
  }
  Heard wait(std::int64_t) {
    (void)rings_->wait(false, false, RL_INFO);
    return Heard::ring;
  }

 private:
  rl::sema_data* rings_;
};

template <typename Bell>
struct LinkModel : rl::test_suite<LinkModel<Bell>, 2> {
  struct Link {
    Turn<ModelMemory> ready, request, answer;
    Cell<int> name{0}, snapshot{0}, status{0};
    Ring<Cell<int>, 2, ModelMemory> commands, lines;
  };
  const std::unique_ptr<Link> link = std::make_unique<Link>();
  Bell runtimes, processes;
  static constexpr std::uint32_t requests = 2;

  void thread(unsigned index) { index == 0 ? runtime() : process(); }

  void runtime() {
    while (link->ready.given() != 1) (void)runtimes.wait(0);
    RL_ASSERT(link->name == 7);
    for (std::uint32_t number = 1; number <= requests; ++number) {
      const int said = static_cast<int>(number);
      link->snapshot = said;
      link->request.give(number, processes);
      while (link->answer.given() != number) {
        tell_lines();  // as when it is buried: the process may be writing
        (void)runtimes.wait(0);
      }
      RL_ASSERT(link->status == 10 * said);
      RL_ASSERT(link->commands.size() == 1 && link->commands.peek() == 100 * said);
      link->commands.drop(1);
    }
  }
  void tell_lines() {
    for (Cell<int> line(0); link->lines.try_pop(line);) RL_ASSERT(line == 5);
  }

  void process() {
    link->name = 7;
    link->ready.give(1, runtimes);
    std::uint32_t done = 0;
    while (done < requests) {
      const auto number = link->request.next(done, processes);
      RL_ASSERT(number.has_value() && *number == done + 1);
      const int asked = link->snapshot;
      (void)link->lines.try_push(Cell<int>(5));
      RL_ASSERT(link->commands.try_push(Cell<int>(100 * asked)));  // those of the answer before are taken
      link->status = 10 * asked;
      done = *number;
      link->answer.give(done, runtimes);
    }
  }
};

}  // namespace

void add_turn_models(std::vector<Model>& models) {
  models.push_back(model<LinkModel<DeafBell>>("the behaviors' process, whatever the bell does", 2));
  models.push_back(model<LinkModel<TrueBell>>("the behaviors' process, asleep until it rings", 2));
}

}  // namespace kadans::interleavings
