// Another program that speaks the low level, with what idlc makes of the list of fields and with a checksum of its own.
// Told by its arguments what to do, in their order:
//
//   unitree_peer DOMAIN go|hg (watch COUNT | stand COUNT | damp COUNT | off COUNT | garbage COUNT | stop COUNT)...
//
// watch takes states; stand leads the motors from where they are to a stance within COUNT commands; damp and off
// command that; garbage writes commands with wrong checksums and with numbers that are none; stop writes the maker's
// "stop" values. A command follows each state. At the end a JSON object goes to stdout. Exit code 1 after a minute in
// which nobody answers.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dds/dds.h>

#include "low_level.h"

namespace {

constexpr const char* loopback = R"(<CycloneDDS><Domain Id="any">
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>)";
constexpr int patience = 600;  // times 0.1 s

dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  std::fprintf(stderr, "unitree_peer: %s: %s\n", what, dds_strretcode(entity));
  std::exit(2);  // NOLINT(concurrency-mt-unsafe): as it is
}

// Bit by bit, over the words of a struct but the last.
template <typename Message>
std::uint32_t crc_of(const Message& message) {
  std::array<std::uint32_t, sizeof(Message) / 4> words{};
  std::memcpy(words.data(), &message, sizeof message);
  std::uint32_t crc = 0xFFFFFFFF;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    for (std::uint32_t bit = 0x80000000; bit != 0; bit >>= 1) {
      const bool turn = ((crc & 0x80000000) != 0) != ((words[i] & bit) != 0);
      crc = (crc << 1) ^ (turn ? 0x04C11DB7U : 0);
    }
  }
  return crc;
}

struct Go {
  using Command = unitree_go_msg_dds__LowCmd_;
  using State = unitree_go_msg_dds__LowState_;
  static constexpr const dds_topic_descriptor_t* command_type = &unitree_go_msg_dds__LowCmd__desc;
  static constexpr const dds_topic_descriptor_t* state_type = &unitree_go_msg_dds__LowState__desc;
  static constexpr std::size_t motors = 12;
  static void fill(Command& message, const State&) {
    message.head[0] = 0xFE;
    message.head[1] = 0xEF;
    message.level_flag = 0xFF;
  }
  // A Go2 that stands: hip, thigh, calf.
  static float stance(std::size_t motor) { return std::array{0.0F, 0.67F, -1.3F}[motor % 3]; }
};

struct Hg {
  using Command = unitree_hg_msg_dds__LowCmd_;
  using State = unitree_hg_msg_dds__LowState_;
  static constexpr const dds_topic_descriptor_t* command_type = &unitree_hg_msg_dds__LowCmd__desc;
  static constexpr const dds_topic_descriptor_t* state_type = &unitree_hg_msg_dds__LowState__desc;
  static constexpr std::size_t motors = 29;
  static void fill(Command& message, const State& state) { message.mode_machine = state.mode_machine; }
  static float stance(std::size_t) { return 0; }
};

template <typename Robot>
class Peer {
 public:
  explicit Peer(dds_domainid_t domain) {
    checked(dds_create_domain(domain, loopback), "no domain");
    participant_ = checked(dds_create_participant(domain, nullptr, nullptr), "no participant");
    const auto topic = [&](const dds_topic_descriptor_t* type, const char* name) {
      return checked(dds_create_topic(participant_, type, name, nullptr, nullptr), name);
    };
    // As the maker's programs do: without a quality of service.
    states_ = checked(dds_create_reader(participant_, topic(Robot::state_type, "rt/lowstate"), nullptr, nullptr),
                      "no reader");
    commands_ = checked(dds_create_writer(participant_, topic(Robot::command_type, "rt/lowcmd"), nullptr, nullptr),
                        "no writer");
    waitset_ = checked(dds_create_waitset(participant_), "no waitset");
    checked(dds_set_status_mask(states_, DDS_DATA_AVAILABLE_STATUS), "no status");
    checked(dds_waitset_attach(waitset_, states_, 0), "not attached");
  }
  ~Peer() { (void)dds_delete(participant_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  void act(const std::string& what, int count) {
    const typename Robot::State begin = newest_;
    for (int i = 1; i <= count; ++i) {
      auto message = blank<typename Robot::Command>();
      Robot::fill(message, newest_);
      const float share = static_cast<float>(i) / static_cast<float>(count);
      for (std::size_t motor = 0; motor < Robot::motors; ++motor) {
        auto& is = message.motor_cmd[motor];
        is.mode = what == "off" ? 0 : 1;
        if (what == "stand") {
          is.q = begin.motor_state[motor].q * (1 - share) + Robot::stance(motor) * share;
          is.kp = 60;
          is.kd = 3;
        }
        if (what == "damp") is.kd = 3;
        if (what == "garbage") is.tau = i % 2 == 0 ? NAN : 5;
        if (what == "stop") {
          is.q = 2.146e9F;
          is.dq = 16000;
        }
      }
      message.crc = crc_of(message) ^ (what == "garbage" && i % 2 == 1 ? 1U : 0U);
      if (what != "watch") (void)dds_write(commands_, &message);
      await_state(what != "watch" ? &message : nullptr);
    }
  }

  void tell() const {
    double error_rad = 0;
    for (std::size_t motor = 0; motor < Robot::motors; ++motor)
      error_rad = std::max(error_rad, std::abs(double{newest_.motor_state[motor].q} - Robot::stance(motor)));
    std::printf("{\"states\": %d, \"bad_checksums\": %d, \"not_newer\": %d, \"error_rad\": %.4f, \"up\": %.3f}\n",
                states_seen_, bad_, not_newer_, error_rad, double{newest_.imu_state.accelerometer[2]});
  }

 private:
  template <typename Message>
  static Message blank() {
    Message message;
    std::memset(&message, 0, sizeof message);
    return message;
  }

  // The next state. A command that nobody answers may be lost: it is written again.
  void await_state(const typename Robot::Command* again) {
    for (int tries = 0; tries < patience; ++tries) {
      auto state = blank<typename Robot::State>();
      void* sample = &state;
      dds_sample_info_t info{};
      if (dds_take(states_, &sample, &info, 1, 1) > 0) {
        if (!info.valid_data) continue;
        ++states_seen_;
        if (crc_of(state) != state.crc) ++bad_;
        if (states_seen_ > 1 && state.tick - newest_.tick > 0x80000000U) ++not_newer_;
        newest_ = state;
        return;
      }
      if (dds_waitset_wait(waitset_, nullptr, 0, 100'000'000) == 0 && again != nullptr)
        (void)dds_write(commands_, again);
    }
    std::fprintf(stderr, "unitree_peer: nobody tells a state\n");
    std::exit(1);  // NOLINT(concurrency-mt-unsafe): as it is
  }

  dds_entity_t participant_ = 0, states_ = 0, commands_ = 0, waitset_ = 0;
  typename Robot::State newest_ = blank<typename Robot::State>();
  int states_seen_ = 0, bad_ = 0, not_newer_ = 0;
};

template <typename Robot>
int talk(int argc, char** argv) {
  Peer<Robot> peer(static_cast<dds_domainid_t>(std::atoi(argv[1])));
  for (int i = 3; i + 1 < argc; i += 2) peer.act(argv[i], std::atoi(argv[i + 1]));
  peer.tell();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  return std::string(argv[2]) == "go" ? talk<Go>(argc, argv) : talk<Hg>(argc, argv);
}
