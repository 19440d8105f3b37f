// Which plisse this is.
#include <plisse/version.h>

#include <iostream>
#include <string>

int main() {
  std::cout << "plisse " << plisse::version << '\n';
  return std::string(plisse::version).find('.') != std::string::npos ? 0 : 1;
}
