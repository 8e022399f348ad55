// A refusal in words, with the names of the catalog: "posture.l_knee.position_rad = 3 is outside its range -2..2 rad".
#pragma once

#include <span>
#include <string>

#include "kadans/control/catalog.h"
#include "kadans/signal/command.h"

namespace kadans {

// The reason as behaviors read it: "out_of_range".
const char* refusal_word(RefusalReason reason) noexcept;
std::string refusal_text(const Refusal& refusal, const Catalog& catalog);
// The same into `text`, cut to its size and ended with 0.
void copy_refusal_text(const Refusal& refusal, const Catalog& catalog, std::span<char> text);

}  // namespace kadans
