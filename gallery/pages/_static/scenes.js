// Scenes are loaded when their tab is opened.
addEventListener('DOMContentLoaded', () => {
  const seen = new IntersectionObserver((entries) => entries.forEach(({ isIntersecting, target }) => {
    if (!isIntersecting) return;
    seen.unobserve(target);
    target.src = target.dataset.src;
  }), { rootMargin: '400px' });
  document.querySelectorAll('iframe[data-src]').forEach((frame) => seen.observe(frame));
});
