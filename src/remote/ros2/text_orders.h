// Orders to an instance and their answers as texts, one JSON object each, for clients that have a topic instead of a
// connection of their own. The verbs are those of the service /kadans/command of the live server.
//
//   {"id": 7, "verb": "play", "text": "squat", "value": 0}      id, text and value may be left out
//   {"id": 7, "verb": "play", "done": true, "text": "..."}      the answer; when done is false, text says why
//
// Each text is answered or refused once. At most 15 orders are on their way. Everything runs on one thread, the
// caller's. Senders on a topic are not authenticated, so nothing is obeyed unless the person who started the run has
// allowed it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/clock.h"
#include "remote/instance/instance.h"
#include "remote/page/live_hub.h"
#include "script/host/behavior_tables.h"

namespace kadans {

struct OrderRequest;

class TextOrders {
 public:
  static constexpr std::size_t text_max_bytes = 16 * 1024;
  static constexpr std::int64_t patience_ns = 10'000'000'000;  // then an order that was not taken up is withdrawn

  struct Parts {
    Instance& instance;
    InstancePort& port;  // this object alone uses its orders and answers
    LivePace* pace = nullptr;
    bool allowed = false;
    std::string refusal;  // when not allowed: says how to allow it
    std::string who;      // for the log
  };
  explicit TextOrders(Parts parts) : p_(std::move(parts)) {}

  // Takes an order. Returns the answer when there is one at once.
  [[nodiscard]] std::optional<std::string> take(std::string_view json);
  // Returns the next answer to an order that was on its way.
  [[nodiscard]] std::optional<std::string> next();
  // Asks what plays, unless that is asked already. behaviors() tells it once, after a next().
  void ask_behaviors();
  [[nodiscard]] std::optional<std::vector<BehaviorReport>> behaviors() { return std::exchange(behaviors_, {}); }

 private:
  struct Asked {
    std::string id;  // JSON; "": none
    std::string verb;
    bool save = false;
    std::string preset;
    std::int64_t asked_ns = 0;
  };
  std::optional<std::string> obey(Asked& asked, const OrderRequest& request);

  Parts p_;
  WallClock clock_;
  std::map<std::uint64_t, Asked> waiting_;  // by the order's number
  std::uint64_t report_ = 0;                // that is on its way
  std::optional<std::vector<BehaviorReport>> behaviors_;
};

}  // namespace kadans
