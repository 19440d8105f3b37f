// One colour; where no colour is written, depth alone.
uniform vec4 flat_colour;
layout(location = 0) out vec4 colour;
void main() { colour = flat_colour; }
