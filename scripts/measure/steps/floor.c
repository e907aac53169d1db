/* The floor of an explicit step of the plane: the law of sprung joints in plain C, without what a run needs beside it.

   No ends of faces, no touches, no accounts, no supports. The last body is the ground, so that no line branches.
   `one_loop` takes one line after the other; `by_body` first finds the forces of all lines, which a compiler
   vectorises, and then sums them body by body. */
#include <math.h>

typedef struct {
    int count;
    const int *body, *face;
    const double *at_x, *at_z, *origin_x, *origin_z, *between_x, *between_z, *normal_x, *normal_z;
    const double *k, *c, *k_s, *c_s, *friction;
    double *grip, *force_x, *force_z, *moment, *moment_of_face;
} Lines;

typedef struct {
    int count;
    const double *mass, *inverse_inertia, *rest_x, *rest_z;
    double *x, *z, *angle, *sine, *versine, *speed_x, *speed_z, *spin, *force_x, *force_z, *moment;
} Bodies;

static void start(Bodies *b, double push) {
    for (int i = 0; i < b->count; i++) {
        double s = sin(0.5 * b->angle[i]), c = cos(0.5 * b->angle[i]);
        b->sine[i] = 2 * s * c;
        b->versine[i] = 2 * s * s;
        b->force_x[i] = -b->mass[i] * push;
        b->force_z[i] = -b->mass[i] * 9.81;
        b->moment[i] = 0;
    }
}

static void move(Bodies *b, double h) {
    for (int i = 0; i < b->count - 1; i++) {
        b->speed_x[i] += h / b->mass[i] * b->force_x[i];
        b->speed_z[i] += h / b->mass[i] * b->force_z[i];
        b->spin[i] += h * b->inverse_inertia[i] * b->moment[i];
        b->x[i] += h * b->speed_x[i];
        b->z[i] += h * b->speed_z[i];
        b->angle[i] += h * b->spin[i];
    }
}

#define LAW                                                                                                     \
    int i = l->body[p], f = l->face[p];                                                                         \
    double ax = l->at_x[p], az = l->at_z[p], ox = l->origin_x[p], oz = l->origin_z[p];                          \
    double tx = az * b->sine[i] - ax * b->versine[i], tz = -ax * b->sine[i] - az * b->versine[i];               \
    double rx = ax + tx, rz = az + tz;                                                                          \
    double dx = l->between_x[p] + b->x[i] + tx - b->x[f] - oz * b->sine[f] + ox * b->versine[f];                \
    double dz = l->between_z[p] + b->z[i] + tz - b->z[f] + ox * b->sine[f] + oz * b->versine[f];                \
    double nx = l->normal_x[p], nz = l->normal_z[p];                                                            \
    double mx = nx + nz * b->sine[f] - nx * b->versine[f], mz = nz - nx * b->sine[f] - nz * b->versine[f];      \
    double sx = b->rest_x[i] - b->rest_x[f] + b->x[i] - b->x[f] + rx;                                           \
    double sz = b->rest_z[i] - b->rest_z[f] + b->z[i] - b->z[f] + rz;                                           \
    double gap = mx * dx + mz * dz, overlap = gap < 0 ? gap : 0;                                                \
    double ux = b->speed_x[i] + b->spin[i] * rz - b->speed_x[f] - b->spin[f] * sz;                              \
    double uz = b->speed_z[i] - b->spin[i] * rx - b->speed_z[f] + b->spin[f] * sx;                              \
    double rate = mx * ux + mz * uz, slip = mz * ux - mx * uz;                                                  \
    double push = -(l->k[p] * overlap + l->c[p] * rate);                                                        \
    push = gap < 0 && push > 0 ? push : 0;                                                                      \
    double limit = l->friction[p] * push, longest = limit / l->k_s[p], grip = l->grip[p] + h * slip;            \
    grip = grip < -longest ? -longest : (grip > longest ? longest : grip);                                      \
    double drag = -l->k_s[p] * grip - l->c_s[p] * slip;                                                         \
    drag = drag < -limit ? -limit : (drag > limit ? limit : drag);                                              \
    l->grip[p] = grip;                                                                                          \
    double fx = push * mx + drag * mz, fz = push * mz - drag * mx, turn = -0.5 * overlap * drag;

static void press(Lines *l, Bodies *b, double h) {
    for (int p = 0; p < l->count; p++) {
        LAW
        b->force_x[i] += fx;
        b->force_z[i] += fz;
        b->moment[i] += rz * fx - rx * fz + turn;
        b->force_x[f] -= fx;
        b->force_z[f] -= fz;
        b->moment[f] -= sz * fx - sx * fz + turn;
    }
}

static void find(Lines *restrict l, Bodies *restrict b, double h) {
#pragma GCC ivdep
    for (int p = 0; p < l->count; p++) {
        LAW
        l->force_x[p] = fx;
        l->force_z[p] = fz;
        l->moment[p] = rz * fx - rx * fz + turn;
        l->moment_of_face[p] = -(sz * fx - sx * fz + turn);
    }
}

/* `listed` has the lines of each body in turn, those whose face it carries as -1 - p. */
static void sum(Lines *l, Bodies *b, const int *first, const int *listed) {
    for (int i = 0; i < b->count - 1; i++)
        for (int q = first[i]; q < first[i + 1]; q++) {
            int p = listed[q], own = p >= 0;
            p = own ? p : -1 - p;
            b->force_x[i] += own ? l->force_x[p] : -l->force_x[p];
            b->force_z[i] += own ? l->force_z[p] : -l->force_z[p];
            b->moment[i] += own ? l->moment[p] : l->moment_of_face[p];
        }
}

void one_loop(Lines *l, Bodies *b, double h, double push, int steps) {
    for (int n = 0; n < steps; n++) {
        start(b, push);
        press(l, b, h);
        move(b, h);
    }
}

void by_body(Lines *l, Bodies *b, double h, double push, int steps, const int *first, const int *listed) {
    for (int n = 0; n < steps; n++) {
        start(b, push);
        find(l, b, h);
        sum(l, b, first, listed);
        move(b, h);
    }
}
