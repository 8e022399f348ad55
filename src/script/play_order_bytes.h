// What the supervisor asks for, and what plays, as bytes and back: between two processes. A value that is not there is
// read as zero or empty, and the reader is not ok() then.
#pragma once

#include "kadans/config/play_order.h"
#include "kadans/signal/byte_order.h"

namespace kadans {

void put_item(const PlayItem& item, ByteWriter& bytes);
PlayItem take_item(ByteReader& bytes);
void put_order(const PlayOrder& order, ByteWriter& bytes);
PlayOrder take_order(ByteReader& bytes);

}  // namespace kadans
