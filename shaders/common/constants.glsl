#define AOV_HEIGHT 0
#define AOV_NORMAL 1
#define AOV_AMPLITUDE 2
#define AOV_PHASE 3
#define AOV_DIRECTION 4
#define AOV_TENSION 5
#define AOV_DEPTH 6
#define AOV_OBJECT 7
const float pi = 3.14159265358979;
