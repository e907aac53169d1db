/* Gaps between the corners of a wall, the base (z = 0) and the side stop (x = -B), and their gradients.

   B and H are half the thickness and half the height of the wall [m]; q is x and z of the centroid [m] and the rotation
   [rad], positive outwards. A gap is along the normal, then along the tangent. Matrices are stored by columns. */

#include <math.h>

static void corner(double a, double c, const double *q, double *place, double *arm)
{
    double cosine = cos(q[2]), sine = sin(q[2]);
    arm[0] = -a * sine + c * cosine;
    arm[1] = -a * cosine - c * sine;
    place[0] = q[0] + a * cosine + c * sine;
    place[1] = q[1] - a * sine + c * cosine;
}

#define ON_BASE(name, a, c)                                                                                            \
    void name##_gap(unsigned size, const double *q, unsigned rows, double *y, unsigned sizez, double *z)               \
    {                                                                                                                  \
        double place[2], arm[2];                                                                                       \
        corner(a, c, q, place, arm);                                                                                   \
        y[0] = place[1];                                                                                               \
        y[1] = place[0];                                                                                               \
    }                                                                                                                  \
    void name##_gradient(unsigned size, const double *q, unsigned rows, double *g, unsigned sizez, double *z)          \
    {                                                                                                                  \
        double place[2], arm[2];                                                                                       \
        corner(a, c, q, place, arm);                                                                                   \
        g[0] = 0, g[1] = 1, g[2] = 1, g[3] = 0, g[4] = arm[1], g[5] = arm[0];                                           \
    }

#define ON_STOP(name, a, c)                                                                                            \
    void name##_gap(unsigned size, const double *q, unsigned rows, double *y, unsigned sizez, double *z)               \
    {                                                                                                                  \
        double place[2], arm[2];                                                                                       \
        corner(a, c, q, place, arm);                                                                                   \
        y[0] = place[0] + B;                                                                                           \
        y[1] = place[1];                                                                                               \
    }                                                                                                                  \
    void name##_gradient(unsigned size, const double *q, unsigned rows, double *g, unsigned sizez, double *z)          \
    {                                                                                                                  \
        double place[2], arm[2];                                                                                       \
        corner(a, c, q, place, arm);                                                                                   \
        g[0] = 1, g[1] = 0, g[2] = 0, g[3] = 1, g[4] = arm[0], g[5] = arm[1];                                           \
    }

ON_BASE(outer, B, -H)
ON_BASE(inner, -B, -H)
ON_STOP(foot, -B, -H)
ON_STOP(head, -B, H)
