// What a client of the live server says once it is connected: texts and binary messages of the Foxglove protocol. Every
// text that it gets is JSON that says what it is, every binary message is of a kind that there is, and who came without
// the token changes nothing.
//
// An input is whether it has the token, then messages: how, length (low byte first), bytes.
#include "remote/page/live_client.h"

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "fuzz_input.h"
#include "fuzz_instance.h"
#include "remote/order/order.h"
#include "remote/page/live_protocol.h"

namespace {

using namespace kadans;
using fuzz::require;

struct Bench {
  fuzz::FuzzInstance instance;
  LivePace pace;
  LiveHub hub{instance.hub_parts(&pace)};
};

class Viewer {
 public:
  Viewer(Bench& bench, bool writes) : bench_(bench), client_(bench.hub, 1, writes, "the input") {
    for (LiveClient::Outgoing out; client_.next(out);) {  // the same to all, and long
    }
  }

  void say(bool binary, std::string_view message) {
    if (binary) {
      client_.binary(fuzz::bytes_in(message));
    } else {
      client_.text(message);
    }
    hear();
  }
  void beat() {
    bench_.instance.step();
    bench_.hub.beat();
    client_.tell_changes();
    hear();
  }
  bool changed() const {
    const InstanceStatus now = status_of(bench_.instance.robot.exchange->snapshot.newest(1), {});
    return parameters() != first_ || now.safety.stopped || bench_.pace.held.load() != held_ ||
           bench_.pace.speed.load() != speed_;
  }

 private:
  std::vector<double> parameters() const {
    std::vector<double> values;
    const ParameterTable& table = bench_.instance.robot.catalog.parameters;
    for (ParameterId id = 0; id < table.size(); ++id) values.push_back(table.newest(id));
    return values;
  }
  void hear() {
    for (LiveClient::Outgoing out; client_.next(out);) {
      require(!out.bytes.empty(), "a message says something");
      if (out.binary) {
        const int kind = std::to_integer<int>(out.bytes.front());
        require(kind == 1 || kind == 3 || kind == 4, "a binary message has a kind");
      } else {
        const auto* text = reinterpret_cast<const char*>(out.bytes.data());
        const std::string_view said(text, out.bytes.size());
        require(said.starts_with(R"({"op":)") && nlohmann::json::accept(said), "a text is JSON and says what it is");
      }
    }
    require(client_.reply_bytes() == 0, "nothing waits for who reads");
  }

  Bench& bench_;
  LiveClient client_;
  std::vector<double> first_ = parameters();
  bool held_ = bench_.pace.held.load();
  double speed_ = bench_.pace.speed.load();
};

// Tells which of these a client with the token may change something by: what is no order is none for the server either.
bool may_change(bool binary, std::string_view message) {
  const std::optional<ServiceCall> call = binary ? read_service_call(fuzz::bytes_in(message)) : std::nullopt;
  if (binary && !call) return false;
  const auto json = read_foreign_json(call ? std::string_view(call->request) : message);
  if (!json || !json->is_object()) return false;
  if (!call) return json->value("op", Json()) == "setParameters";
  const Json verb = json->value("verb", Json());
  const OrderInfo* order = verb.is_string() ? find_order(verb.get_ref<const std::string&>()) : nullptr;
  return order != nullptr && order->is_brief();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::KeptBench<Bench> kept;
  fuzz::FuzzInput input(data, size);
  const bool writes = (input.byte() & 1U) != 0;
  bool used = false;
  {
    Viewer viewer(kept.get(), writes);
    for (int i = 0; !input.empty(); ++i) {
      const bool binary = (input.byte() & 1U) != 0;
      const std::string_view message = input.take(input.length());
      used = used || (writes && may_change(binary, message));
      viewer.say(binary, message);
      if (i < 4) viewer.beat();
    }
    viewer.beat();
    require(writes || !viewer.changed(), "who has no token changes nothing");
  }
  if (used) kept.changed_by({reinterpret_cast<const char*>(data), size});
  return 0;
}
