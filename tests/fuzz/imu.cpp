// Bytes from an IMU's serial line, while it is found and set up and when it is read: readings are finite, within what a
// device measures, and their times do not run away from the clock. And bytes to the emulated device.
//
// An input is a byte that chooses, then pieces: length, bytes. A piece whose length is odd gets a head and a right sum.
#include <algorithm>
#include <cmath>
#include <memory>

#include "fuzz_input.h"
#include "plant/imu/emulator/emulated_imu.h"
#include "plant/imu/serial_imu.h"

namespace {

using namespace kadans;
using namespace kadans::imu;
using fuzz::require;

std::string next_piece(fuzz::FuzzInput& input) {
  const std::size_t length = input.byte();
  std::string piece(input.take(length));
  if (length % 2 == 0 || piece.size() < message_overhead) return piece;
  piece[0] = static_cast<char>(0xFA);
  piece[1] = static_cast<char>(0xFF);
  piece[3] = static_cast<char>(piece.size() - message_overhead);
  unsigned sum = 0;
  for (std::size_t i = 1; i + 1 < piece.size(); ++i) sum += static_cast<std::uint8_t>(piece[i]);
  piece.back() = static_cast<char>(0U - sum);
  return piece;
}

class PiecesPort final : public SerialPort {
 public:
  explicit PiecesPort(fuzz::FuzzInput& input) : input_(input) {}
  bool send(Octets) noexcept override { return true; }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override {
    require(into.size() >= 255, "a scanner has room for more");
    now_ = std::max(now_ + 1000, std::min(until_ns, now_ + 100'000'000));
    if (input_.empty()) return 0;
    const std::string piece = next_piece(input_);
    std::copy_n(piece.begin(), piece.size(), into.begin());
    return piece.size();
  }
  void discard() noexcept override {}
  std::int64_t now_ns() const noexcept override { return now_; }

 private:
  fuzz::FuzzInput& input_;
  std::int64_t now_ = 0;
};

void try_driver(fuzz::FuzzInput& input, Protocol protocol) {
  SerialImu imu({.device = "imu", .protocol = protocol, .patience_s = 0.01}, std::make_unique<PiecesPort>(input));
  try {
    (void)imu.open(nullptr);
  } catch (const InputError& error) {
    require(!error.problems().front().message.empty(), "an error says what is wrong");
  }
  std::uint32_t sequence = imu.news().sample.sequence;
  while (!input.empty()) {
    imu.receive(imu.now_ns() + 1'000'000);
    const ImuSample& sample = imu.news().sample;
    for (std::size_t i = 0; i < 3; ++i)
      require(std::abs(sample.acceleration_m_s2[i]) <= acceleration_max_m_s2 &&
                  std::abs(sample.angular_velocity_rad_s[i]) <= gyro_max_rad_s,
              "a reading is one that a device measures");
    if (sample.sequence != sequence) require(sample.time_ns <= imu.now_ns(), "a reading is not of the future");
    sequence = sample.sequence;
  }
}

void try_device(fuzz::FuzzInput& input) {
  EmulatedImu device({.old = input.byte() % 2 == 1}, 1);
  std::array<std::uint8_t, 512> out{};
  for (std::int64_t now_ns = 0; !input.empty(); now_ns += 10'000'000) {
    const std::string piece = next_piece(input);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(piece.data());
    device.receive({bytes, piece.size()}, now_ns, 115'200);
    device.pass(now_ns);
    while (device.take(out, now_ns) > 0) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::FuzzInput input(data, size);
  switch (input.byte() % 3) {
    case 0:
      try_driver(input, Protocol::mtdata2);
      break;
    case 1:
      try_driver(input, Protocol::mtdata);
      break;
    default:
      try_device(input);
      break;
  }
  return 0;
}
