const float pi = 3.14159265358979;
