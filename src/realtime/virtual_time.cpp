#include "kadans/realtime/virtual_time.h"

#include <algorithm>
#include <limits>

namespace kadans {

class VirtualTime::Member final : public Wait {
 public:
  Member(VirtualTime& time, Place& place) noexcept : time_(time), place_(&place) {}
  ~Member() override { end(); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  std::int64_t now_ns() const noexcept override { return time_.now_ns(); }
  void until(std::int64_t time_ns) noexcept override { time_.wait(*place_, time_ns); }
  void end() noexcept override {
    if (place_ != nullptr) time_.leave(*place_);
    place_ = nullptr;
  }

 private:
  VirtualTime& time_;
  Place* place_;
};

std::unique_ptr<Wait> VirtualTime::make_wait() {
  const std::lock_guard lock(mutex_);
  places_.push_back(std::make_unique<Place>());
  return std::make_unique<Member>(*this, *places_.back());
}

void VirtualTime::wait(Place& place, std::int64_t time_ns) noexcept {
  std::unique_lock lock(mutex_);
  if (time_ns <= now_ns()) return;
  place = {time_ns, true};
  advance();
  moved_.wait(lock, [&place] { return !place.waits; });
}

void VirtualTime::leave(const Place& place) noexcept {
  const std::lock_guard lock(mutex_);
  std::erase_if(places_, [&place](const auto& one) { return one.get() == &place; });
  advance();
}

// With the lock held.
void VirtualTime::advance() noexcept {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const auto& place : places_) {
    if (!place->waits) return;
    first_ns = std::min(first_ns, place->due_ns);
  }
  if (places_.empty()) return;
  now_ns_.store(first_ns, std::memory_order_release);
  for (const auto& place : places_) place->waits = place->due_ns > first_ns;
  moved_.notify_all();
}

}  // namespace kadans
