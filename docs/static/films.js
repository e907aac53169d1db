// Plays a film while it is in sight, but for readers who have asked for less motion. One that a reader has stopped stays so.
const still = matchMedia('(prefers-reduced-motion: reduce)');
const seen = new IntersectionObserver(
  entries => {
    for (const {target, isIntersecting} of entries) {
      target.inSight = isIntersecting;
      if (!isIntersecting) target.pause();
      else if (!still.matches && !target.stopped) target.play().catch(() => {});
    }
  },
  {threshold: 0.3},
);
addEventListener('DOMContentLoaded', () => {
  for (const film of document.querySelectorAll('video')) {
    film.onpause = () => (film.stopped = film.inSight);
    film.onplay = () => (film.stopped = false);
    seen.observe(film);
  }
});
