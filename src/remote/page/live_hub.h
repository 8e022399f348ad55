// The state that all clients of a live server share: the instance's port, the channels, the last known parameters, and
// the orders that wait for their answers. The server's thread drives it by beat().
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

#include "live_content.h"
#include "remote/instance/instance.h"

namespace kadans {

struct OrderRequest;

// Carries what clients ask of a simulation (speed, hold, steps, pushes) from the server's thread to the simulation's
// thread.
struct LivePace {
  static constexpr std::size_t pushes_max = 8;
  std::atomic<double> speed{1};
  std::atomic<bool> held{false};
  std::atomic<std::uint32_t> steps{0};  // steps to take while it is held
  // To be set before the server starts. Throws InputError for an invalid push.
  std::function<void(const std::string&)> check_push;

  // Server's thread. False: too many pushes wait. Throws what check_push throws.
  [[nodiscard]] bool push(const std::string& what);
  // Carries out an order of OrderInfo::Faces::paced. Throws what push() throws, and InputError when too many pushes
  // wait.
  void obey(const OrderRequest& request);
  // Simulation's thread: takes the waiting pushes, such as "torso=0,2,0", an impulse in Ns. Mostly none wait; then it
  // costs one atomic load.
  std::vector<std::string> take_pushes();

 private:
  std::atomic<bool> pushed_{false};
  std::mutex mutex_;
  std::vector<std::string> pushes_;
};

class LiveClient;

struct LiveParameter {
  std::string name;  // a name of the parameter table, or BEHAVIOR.NAME
  double value = 0;
};

class LiveHub {
 public:
  struct Parts {
    Instance& instance;
    InstancePort& port;
    RobotTexts texts;
    std::string urdf_file;  // the URDF's file; meshes are found from its folder
    std::vector<TimingSource> timing;
    LivePace* pace = nullptr;
  };
  // A viewer shall get 60 rows a second. Somewhat more rows are requested, and beats come twice as often as rows, so
  // that no row is missed when a beat is late by its whole period.
  static constexpr double rows_hz = 70, beats_hz = 2 * rows_hz, idle_hz = 60;

  // Bound of the waiting replies of all clients together.
  static constexpr std::size_t replies_max_bytes = std::size_t{64} << 20U;

  explicit LiveHub(Parts parts);

  // Call it before the first beat. The sources are read while the server runs.
  void watch_timing(std::vector<TimingSource> timing) { p_.timing = std::move(timing); }
  // To be called about rate_hz() times a second: takes everything new from the instance.
  void beat();
  double rate_hz() const noexcept { return clients_.empty() ? idle_hz : beats_hz; }

  const LiveChannels& channels() const noexcept { return channels_; }
  // The first message to a client: who the server is and what it offers. The text is shared by all clients.
  const std::string& introduction(bool writes);
  const std::string& advertisement();  // of the channels
  LiveAssets& assets() noexcept { return assets_; }
  const std::vector<LiveParameter>& parameters() const noexcept { return parameters_; }
  const std::vector<LiveParameter>& changed() const noexcept { return changed_; }  // changed in the last beat
  const std::string& state() const noexcept { return state_; }                     // JSON with paused, held, speed
  // Writes the tuned parameters into the robot's configuration; what came of it is the answer.
  Answer save(const Answer& answer, const std::string& who, const std::string& preset);
  std::uint64_t state_count() const noexcept { return state_count_; }

  void enter(std::uint64_t id, LiveClient& client) { clients_[id] = &client; }
  // Withdraws the client's orders that have not been taken up.
  void leave(std::uint64_t id);
  // To be called when replies were queued: when all clients' replies together are too many, closes the client with the
  // most; those without the token go first.
  void bound_replies() noexcept;
  // `call` is the number by which the client recognises the answer. False: too many orders wait.
  [[nodiscard]] bool send(Order order, std::uint64_t client, std::uint32_t call);
  // To be called when an order has set this parameter.
  void settled(const std::string& name, double value);
  // Carries out the orders that need no other thread: the emergency stop and the pace. Throws InputError.
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
  std::string plays_;                         // the playable behaviors as in introductions_
  std::array<std::string, 2> introductions_;  // for readers, for writers; "": not made yet
  std::string advertisement_;
  std::map<std::uint64_t, LiveClient*> clients_;
  std::map<std::uint64_t, Caller> waiting_;  // by the order's number
  std::vector<LiveParameter> parameters_, changed_;
  std::vector<LiveParameter> behaviors_now_;
  std::map<std::string, std::uint64_t> charts_;  // the charts that clients know, by behavior
  std::string state_;
  std::uint64_t state_count_ = 0, beats_ = 0, last_tick_ = 0;
  bool wanted_ = false, report_waits_ = false, paused_ = false;
};

}  // namespace kadans
