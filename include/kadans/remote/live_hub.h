// What all clients of a live server share: the instance's port, the channels, the parameters as they were last told,
// and the orders that wait for their answers. One thread, the server's, drives it by beat().
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "kadans/remote/instance.h"
#include "kadans/remote/live_assets.h"
#include "kadans/remote/live_channels.h"

namespace kadans {

struct OrderRequest;

// What clients ask of a simulation, from the server's thread to its own. Null where there is none.
struct LivePace {
  static constexpr std::size_t pushes_max = 8;
  std::atomic<double> speed{1};
  std::atomic<bool> held{false};
  std::atomic<std::uint32_t> steps{0};  // to take while it is held
  // Set before the server starts. Throws InputError on a push that is none.
  std::function<void(const std::string&)> check_push;

  // Server's thread. False: too many wait. Throws what check_push throws.
  [[nodiscard]] bool push(const std::string& what);
  // An order whose face is `paced`. Throws as push(), or when too many wait.
  void obey(const OrderRequest& request);
  // The simulation's: "torso=0,2,0", an impulse in Ns; none wait mostly, and then this is one load.
  std::vector<std::string> take_pushes();

 private:
  std::atomic<bool> pushed_{false};
  std::mutex mutex_;
  std::vector<std::string> pushes_;
};

class LiveClient;

struct LiveParameter {
  std::string name;  // of the table, or BEHAVIOR.NAME
  double value = 0;
};

class LiveHub {
 public:
  struct Parts {
    Instance& instance;
    InstancePort& port;
    RobotTexts texts;
    std::string urdf_file;  // where its meshes are found from
    std::vector<TimingSource> timing;
    LivePace* pace = nullptr;
  };
  // A viewer is to get 60 rows a second: somewhat more are asked for, and looked for twice as often as they come, so
  // that a beat that is late by its whole period costs none.
  static constexpr double rows_hz = 70, beats_hz = 2 * rows_hz, idle_hz = 60;

  // Replies that wait for all clients together.
  static constexpr std::size_t replies_max_bytes = std::size_t{64} << 20U;

  explicit LiveHub(Parts parts);

  // Before the first beat; what is given is read while it runs.
  void watch_timing(std::vector<TimingSource> timing) { p_.timing = std::move(timing); }
  // Some rate_hz() times a second: takes what the instance has.
  void beat();
  double rate_hz() const noexcept { return clients_.empty() ? idle_hz : beats_hz; }

  const Instance& instance() const noexcept { return p_.instance; }
  const LiveChannels& channels() const noexcept { return channels_; }
  // What a client is told first, who the server is and what there is. Made once for all clients.
  const std::string& introduction(bool writes);
  const std::string& advertisement();  // of the channels
  LiveAssets& assets() noexcept { return assets_; }
  const std::vector<LiveParameter>& parameters() const noexcept { return parameters_; }
  const std::vector<LiveParameter>& changed() const noexcept { return changed_; }  // in the last beat
  const std::string& state() const noexcept { return state_; }                     // JSON: paused, held, speed
  // Writes parameters that were tuned into the robot's configuration. Throws InputError, std::system_error.
  std::string save(const Answer& answer, const std::string& who, const std::string& preset);
  std::uint64_t state_count() const noexcept { return state_count_; }

  void enter(std::uint64_t id, LiveClient& client) { clients_[id] = &client; }
  // Its orders that were not taken up yet expire.
  void leave(std::uint64_t id);
  // A client's replies were put into its queue: the client that lets most wait goes when all are too many.
  void bound_replies() noexcept;
  // `call`: what the client knows its answer by. False: too many orders wait.
  [[nodiscard]] bool send(Order order, std::uint64_t client, std::uint32_t call);
  // An order has set this parameter.
  void settled(const std::string& name, double value);
  // What no thread is asked for: the emergency stop and the pace. Throws InputError.
  void act(const OrderRequest& request, const std::string& who);
  bool can_pace() const noexcept { return p_.pace != nullptr; }

 private:
  struct Caller {
    std::uint64_t client;
    std::uint32_t call;
  };
  void take_answers();
  void take_own(std::uint32_t call, const Answer& answer);
  void take_report(const Answer& answer);
  void take_parameters();
  void note(const std::string& name, double value);
  void tell_state();

  Parts p_;
  LiveChannels channels_;
  LiveAssets assets_;
  std::string plays_;                         // what can be played, as introductions_ tell
  std::array<std::string, 2> introductions_;  // to who reads, to who writes; "": not made yet
  std::string advertisement_;
  std::map<std::uint64_t, LiveClient*> clients_;
  std::map<std::uint64_t, Caller> waiting_;  // by the order's number
  std::vector<LiveParameter> parameters_, changed_;
  std::vector<LiveParameter> behaviors_now_;
  std::map<std::string, std::uint64_t> charts_;  // that were told, by behavior
  std::string state_;
  std::uint64_t state_count_ = 0, beats_ = 0, last_tick_ = 0;
  bool wanted_ = false, report_waits_ = false, paused_ = false;
};

}  // namespace kadans
