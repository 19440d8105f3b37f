// Keys as a table of Markdown: the documents' lists of keys are made by this.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/key.h"

namespace plisse::config {

struct Column {
  std::string title;
  std::function<std::string(const KeyText&)> cell;
};

// A head and a line a key; "|" in a cell is escaped.
std::string key_table(const std::vector<KeyText>& keys, const std::vector<Column>& columns);

// What most tables have: `name`, allowed, what it does.
Column name_column();
Column allowed_column();
Column doc_column();

}  // namespace plisse::config
