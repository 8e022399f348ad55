// A plug-in's control object on the program's side. Every call to it goes through the seam of plugin.h; everything that
// comes back is checked.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/plugin.h"

namespace kadans {

class PluginObject final : public ControlObject {
 public:
  // `type` stays valid. Throws std::invalid_argument with the plug-in's reason.
  PluginObject(const PluginType& type, const ObjectSetup& setup);
  ~PluginObject() override;

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override;
  void cancel_motion(std::uint32_t channel) noexcept override;
  double motion_remaining_s() const noexcept override;
  void parameters_changed() noexcept override;
  void update(const Snapshot& snapshot) override;

 private:
  struct Told;  // collects what the object declares

  template <typename Call>
  void call(Call&& call) const noexcept;

  const PluginType& type_;
  std::vector<std::size_t> joints_;
  void* object_ = nullptr;
  std::vector<double> parameters_, passed_on_;  // as set by the engine; as the object knows them
  std::vector<double> signals_;
  mutable std::atomic<bool> threw_ = false;  // in either thread
  bool failed_ = false;                      // as the control thread saw it last
};

}  // namespace kadans
