// What goes wrong arrives as one exception, with its kind and a sentence to show.
#include <plisse/error.h>
#include <plisse/mesh.h>

#include <iostream>

int main() {
  try {
    plisse::load_mesh("no_such_file.ply");
  } catch (const plisse::Error& error) {
    std::cout << error.what() << '\n';
    return error.code == plisse::ExitCode::bad_input ? 0 : 1;
  }
  return 1;
}
