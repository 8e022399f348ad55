#include "board_world.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "plant/hostmot2/mapped_link.h"
#include "signal/input_file.h"
#include "signal/owned_descriptor.h"

namespace kadans::hostmot2 {
namespace {

// A card on PCI answers at once; its register file does so here at each write outside of the tick's.
class VirtualCard final : public MappedLink {
 public:
  VirtualCard(const std::string& path, RegisterFile& file) : MappedLink(path), file_(file) {}
  bool write(RegisterWrite one) override {
    const bool good = MappedLink::write(one);
    answer();
    return good;
  }
  void write_all(std::span<const RegisterWrite> writes) noexcept override {
    MappedLink::write_all(writes);
    answer();
  }

 private:
  void answer() noexcept {
    file_.take();
    file_.show();
  }
  RegisterFile& file_;
};

constexpr std::int64_t virtual_patience_ns = 50'000'000;

constexpr std::size_t file_bytes = 0x10000, used_bytes = 0x5000;
// No pin has this bit: it tells the state of pins, which is shown, from an output that was written with the same bits.
constexpr std::uint32_t shown_pins = 0x80000000;

bool readable(unsigned address) noexcept {
  const unsigned block = address & 0xFF00U;
  return (address >= 0x100 && address < 0x200) || (address >= 0x400 && address < 0x1200) || block == 0x3000 ||
         block == 0x3100 || block == 0x3300;
}

}  // namespace

RegisterFile::RegisterFile(EmulatedBoard& board, const std::string& path) : board_(board), shown_(used_bytes / 4) {
  const OwnedDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  const bool good = file && ftruncate(file.number(), file_bytes) == 0;
  void* const memory =
      good ? mmap(nullptr, file_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.number(), 0) : MAP_FAILED;
  if (memory == MAP_FAILED) refuse(path + ": " + std::system_category().message(errno));
  registers_ = static_cast<volatile std::uint32_t*>(memory);
  for (std::size_t i = 0; i < shown_.size(); ++i) registers_[i] = 0;
  show();
}

RegisterFile::~RegisterFile() { munmap(const_cast<std::uint32_t*>(registers_), file_bytes); }

void RegisterFile::take() noexcept {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const std::uint32_t is = registers_[i];
    if (is == shown_[i]) continue;
    (void)board_.write(static_cast<unsigned>(4 * i), is);
    shown_[i] = is;
  }
}

void RegisterFile::show() noexcept {
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const auto address = static_cast<unsigned>(4 * i);
    std::uint32_t is = 0;
    if (!readable(address) || !board_.read(address, is)) continue;
    if ((address & 0xFF00U) == 0x1000) is |= shown_pins;
    registers_[i] = shown_[i] = is;
  }
}

bool VirtualCable::send(Octets datagram) noexcept {
  sent = datagram.size();
  if (holds) {
    std::copy_n(datagram.begin(), sent, held_.begin());
    return true;
  }
  passed_.pass(datagram, now_);
  wire_.receive(datagram, now_);
  return true;
}

std::size_t VirtualCable::receive(std::span<std::uint8_t> into, std::int64_t) noexcept {
  if (holds) {
    std::copy_n(held_.begin(), std::min(answered_, into.size()), into.begin());
    return std::exchange(answered_, 0);
  }
  const std::vector<std::uint8_t> bytes = wire_.take(now_);
  std::copy_n(bytes.begin(), std::min(bytes.size(), into.size()), into.begin());
  if (!bytes.empty()) {
    passed_.pass(bytes, now_);
    received = bytes.size();
  }
  return bytes.size();
}

void VirtualCable::await(std::int64_t until_ns) noexcept { now_ = std::max(now_, std::min(until_ns, wire_.due_ns())); }

void VirtualCable::answer() {
  wire_.receive({held_.data(), sent}, now_);
  const std::vector<std::uint8_t> bytes = wire_.take(now_);
  std::ranges::copy(bytes, held_.begin());
  answered_ = bytes.size();
}

BoardWorld::BoardWorld(std::unique_ptr<World> model, const HostMot2Settings& settings, const HostMot2Settings& there,
                       const PlantSite& site)
    : WiredWorld(std::move(model)), machine_(there, site, site.seed), wired_feet_(!settings.feet.empty()) {
  std::vector<std::unique_ptr<BoardLink>> links;
  for (std::size_t i = 0; i < settings.boards.size(); ++i) {
    const std::string& resource = settings.boards[i].resource;
    if (!resource.empty()) {
      files_.push_back(std::make_unique<RegisterFile>(machine_.board(i), resource));
      links.push_back(std::make_unique<VirtualCard>(resource, *files_.back()));
      continue;
    }
    auto cable = std::make_unique<VirtualCable>(machine_.wire(i));
    cables_.push_back(cable.get());
    links.push_back(std::make_unique<LbpLink>(std::move(cable), virtual_patience_ns, 0));
  }
  plant_ = std::make_unique<HostMot2Plant>(settings, site, std::move(links));
  machine_.look(inner());
  for (const auto& file : files_) file->show();
}

void BoardWorld::set_time(std::int64_t now_ns) noexcept {
  for (VirtualCable* cable : cables_) cable->set(now_ns);
}

void BoardWorld::take(SensorFrame& sensors) noexcept {
  const auto feet = sensors.feet;
  plant_->read(sensors);
  if (!wired_feet_) sensors.feet = feet;
}

void BoardWorld::begin_step() {
  for (const auto& file : files_) file->take();
}

void BoardWorld::end_step() {
  machine_.look(inner());
  for (const auto& file : files_) file->show();
}

std::uint64_t BoardWorld::passed() const noexcept {
  StateHash all;
  for (const VirtualCable* cable : cables_) all.add(cable->passed());
  return all.value();
}

}  // namespace kadans::hostmot2
