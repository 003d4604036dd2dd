/* What lanes.c defines, one lane wide. */

#include <math.h>
#include <stddef.h>
#include <string.h>

#define LANES 1
#define REAL double
#define R(number) (number)
#define SIZE(a) fabs(a)
#define LARGER(a, b) ((a) > (b) ? (a) : (b))
#define LANE(vector, lane) (*((void)(lane), &(vector)))
#define EACH_LANE for (int l = 0; l < LANES; l++)
