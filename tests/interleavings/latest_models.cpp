// Latest, LatestRow, and a model's end of the plant link beside the control thread's.
#include <memory>

#include "checker.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/one_writer.h"
#include "remote/instance/latest_row.h"

namespace kadans::interleavings {
namespace {

// Whole when the halves agree. That they were not written meanwhile the cells see to.
struct Pair {
  explicit Pair(int n = 0) : number(n), twice(2 * n) {}
  int whole() const {
    const int found = number;
    RL_ASSERT(twice == 2 * found);
    return found;
  }

  Cell<int> number, twice;
};

// Slots are aligned to lines, which Relacy's own allocation is not.
template <std::size_t Readers>
using Pairs = Latest<Pair, Readers, ModelMemory>;

constexpr int published = 3;

template <std::size_t Readers>
void publish_all(Pairs<Readers>& latest) {
  for (int i = 1; i <= published; ++i) latest.publish(Pair(i));
}

// Never older than the last, news is new, and a reading stays what it is while its thread reads again.
template <std::size_t Readers>
void read_some(Pairs<Readers>& latest, std::size_t reader, int times) {
  for (int last = 0; times > 0; --times) {
    const bool news = latest.has_news(reader);
    const auto reading = latest.read(reader);
    const int found = reading->whole();
    RL_ASSERT(news ? found > last : found >= last);
    last = found;
    const auto again = latest.read(reader);
    RL_ASSERT(again->whole() == found && reading->whole() == found);
  }
}

template <std::size_t Readers>
struct LatestModel : rl::test_suite<LatestModel<Readers>, 1 + static_cast<int>(Readers)> {
  const std::unique_ptr<Pairs<Readers>> latest = std::make_unique<Pairs<Readers>>(Pair(0));

  void thread(unsigned index) {
    if (index == 0) publish_all(*latest);
    if (index > 0) read_some(*latest, index - 1, 3);
  }
  void after() {
    for (std::size_t reader = 0; reader < Readers; ++reader) RL_ASSERT(latest->newest(reader).whole() == published);
  }
};

// What Reading is there to prevent: a value looked at after its reading ended, when the thread has read again.
struct KeptTooLong : rl::test_suite<KeptTooLong, 2> {
  const std::unique_ptr<Pairs<1>> latest = std::make_unique<Pairs<1>>(Pair(0));

  void thread(unsigned index) {
    if (index == 0) return publish_all(*latest);
    const Pair* kept = nullptr;
    {
      const auto reading = latest->read();
      kept = &*reading;
    }
    (void)latest->newest();
    (void)kept->whole();
  }
};

// The model steps and publishes what its sensors say; the control thread reads that and leaves its actuation.
struct PlantLinkModel : rl::test_suite<PlantLinkModel, 2> {
  const std::unique_ptr<Pairs<1>> sensors = std::make_unique<Pairs<1>>(Pair(0));
  const std::unique_ptr<Pairs<1>> actuation = std::make_unique<Pairs<1>>(Pair(0));

  void thread(unsigned index) {
    for (int i = 1; i <= 3; ++i) {
      if (index == 0) {
        RL_ASSERT(actuation->newest().whole() < i);  // it answers what was published
        sensors->publish(Pair(i));
      } else {
        const auto reading = sensors->read();
        const int found = reading->whole();
        actuation->publish(Pair(found));
        RL_ASSERT(reading->whole() == found);
      }
    }
  }
};

struct RowModel : rl::test_suite<RowModel, 2> {
  using Row = BasicLatestRow<ModelMemory, Cell<double>>;
  const std::unique_ptr<Row> row = std::make_unique<Row>(2);

  void before() { row->want(1); }
  void thread(unsigned index) {
    if (index == 0) {
      for (std::uint64_t tick = 1; tick <= 4; ++tick) {
        const double number = static_cast<double>(tick);
        row->publish(tick, 10 * static_cast<std::int64_t>(tick), std::array{number, 2 * number});
      }
      return;
    }
    for (std::uint64_t times = 3, last = 0; times > 0; --times) {
      const auto reading = row->read();
      if (reading->values.empty()) continue;
      RL_ASSERT(reading->tick >= last && reading->time_ns == 10 * static_cast<std::int64_t>(reading->tick));
      last = reading->tick;
      const auto again = row->read();
      RL_ASSERT(again->tick == last && again->values[1] == 2 * reading->values[0]);
      RL_ASSERT(reading->values[0] == static_cast<double>(last));
    }
    row->want(0);
  }
};

// A count goes up for whoever looks, however seldom.
struct CountModel : rl::test_suite<CountModel, 3> {
  OneWriter<std::uint64_t, ModelMemory> count;

  void thread(unsigned index) {
    std::uint64_t last = 0;
    for (int i = 0; i < 3; ++i) {
      if (index == 0) {
        count.add(1);
      } else {
        const std::uint64_t found = count.get();
        RL_ASSERT(found >= last && found <= 3);
        last = found;
      }
    }
  }
  void after() const { RL_ASSERT(count.get() == 3); }
};

}  // namespace

void add_latest_models(std::vector<Model>& models) {
  models.push_back(model<LatestModel<1>>("Latest, one reader", 4));
  models.push_back(model<LatestModel<2>>("Latest, two readers", 2));
  models.push_back(misuse<KeptTooLong>("Latest, a value kept longer than its reading"));
  models.push_back(model<PlantLinkModel>("the plant's link", 3));
  models.push_back(model<RowModel>("LatestRow", 2));
  models.push_back(model<CountModel>("OneWriter, two readers", 2));
}

}  // namespace kadans::interleavings
