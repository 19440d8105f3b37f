#include "config/key_table.h"

namespace plisse::config {

std::string key_table(const std::vector<KeyText>& keys, const std::vector<Column>& columns) {
  std::string text = "|", rule = "|";
  for (const Column& column : columns) {
    text += " " + column.title + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const KeyText& key : keys) {
    text += "|";
    for (const Column& column : columns) {
      text += " ";
      for (const char c : column.cell(key)) text += c == '|' ? "\\|" : std::string(1, c);
      text += " |";
    }
    text += "\n";
  }
  return text;
}

Column name_column() {
  return {"key", [](const KeyText& key) { return "`" + key.name + "`"; }};
}
Column allowed_column() {
  return {"allowed", [](const KeyText& key) { return key.allowed; }};
}
Column doc_column() {
  return {"what it does", [](const KeyText& key) { return key.doc; }};
}

}  // namespace plisse::config
