// What a client of the live server says once it is connected: texts and binary messages of the Foxglove protocol. Every
// text that it gets is JSON that says what it is, every binary message is of a kind that there is, and who came without
// the token changes nothing.
//
// An input is whether it has the token, then messages: how, length (low byte first), bytes.
#include "kadans/remote/live_client.h"

#include <nlohmann/json.hpp>

#include "fuzz_input.h"
#include "fuzz_instance.h"

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
    return parameters() != first_ || now.safety.stopped || bench_.pace.held.load() || bench_.pace.speed.load() != 1;
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
        const auto json = nlohmann::json::parse(text, text + out.bytes.size(), nullptr, false);
        require(json.is_object() && json.contains("op"), "a text is JSON and says what it is");
      }
    }
    require(client_.reply_bytes() == 0, "nothing waits for who reads");
  }

  Bench& bench_;
  LiveClient client_;
  std::vector<double> first_ = parameters();
};

// Tells which of these a client with the token may change something by.
bool may_change(bool binary, std::string_view message) {
  return binary ? message.starts_with('\2') : message.find_first_of("P\\") != std::string_view::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<Bench> kept;  // until an input changes it
  if (!kept) kept = std::make_unique<Bench>();
  fuzz::FuzzInput input(data, size);
  const bool writes = (input.byte() & 1U) != 0;
  bool used = false;
  {
    Viewer viewer(*kept, writes);
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
  if (used) kept.reset();
  return 0;
}
