// The key 'fabric' of panel files and drape scenes: a text as parse_fabric takes it, or a table of numbers.
#pragma once

#include <optional>

#include "config/kinds.h"
#include "sizing/fabric.h"

namespace plisse::config {

// None where something is wrong in a table of numbers, which complains of it.
Kind<std::optional<sizing::Fabric>> fabric();

}  // namespace plisse::config
