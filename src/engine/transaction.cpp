#include "transaction.h"

namespace kadans {

void CommandSender::begin(std::int64_t time_ns) noexcept {
  discard();
  committed_ = 0;
  time_ns_ = time_ns;
}

bool CommandSender::add(const Command& command) noexcept {
  // Places in the queue only grow until this producer pushes, so what fits now fits at the commit.
  const bool fits = overflow_ == 0 && size_ < max_transaction && size_ + 1 <= room();
  if (!fits) {
    ++overflow_;
    return false;
  }
  batch_[size_++] = command;
  switches_ = switches_ || command.kind == CommandKind::switch_set;
  return true;
}

std::uint32_t CommandSender::commit() noexcept {
  const std::size_t wanted = size_ - 1 + overflow_;
  committed_ = 0;
  if (wanted == 0) return sequence_;
  batch_[0] = Command{.kind = CommandKind::transaction,
                      .count = static_cast<std::uint32_t>(size_ - 1),
                      .sequence = sequence_ + 1,
                      .time_ns = time_ns_};
  const bool sent = overflow_ == 0 && queue_.try_push(std::span<const Command>(batch_.data(), size_));
  if (sent && told_ != nullptr) told_->sent({batch_.data(), size_}, in_tick_);
  const std::size_t commands = size_ - 1;
  const bool switches = switches_;
  discard();
  if (!sent) {
    refused_ += wanted;
    return 0;
  }
  if (room_ != SIZE_MAX) room_ -= commands + 1;
  sent_ += wanted;
  committed_ = commands;
  ++sequence_;
  if (switches) switch_ = sequence_;
  return sequence_;
}

void CommandSender::follow(std::uint32_t last_sequence, std::size_t room) noexcept {
  discard();
  committed_ = 0;
  sequence_ = last_sequence;
  room_ = room;
}

void CommandSender::discard() noexcept {
  size_ = 1;
  overflow_ = 0;
  switches_ = false;
}

}  // namespace kadans
