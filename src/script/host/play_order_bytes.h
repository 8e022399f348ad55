// Writes orders and items of the play list as bytes for another process, and reads them back. A missing value is read
// as zero or empty, and then the reader is not ok().
#pragma once

#include "config/scenario/play_item.h"
#include "signal/byte_order.h"

namespace kadans {

void put_item(const PlayItem& item, ByteWriter& bytes);
PlayItem take_item(ByteReader& bytes);
void put_order(const PlayOrder& order, ByteWriter& bytes);
PlayOrder take_order(ByteReader& bytes);

}  // namespace kadans
