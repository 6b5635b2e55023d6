// Scenes are loaded when they come near or their tab is opened, after the page itself.
addEventListener('load', () => {
  const seen = new IntersectionObserver((entries) => entries.forEach(({ isIntersecting, target }) => {
    if (!isIntersecting) return;
    seen.unobserve(target);
    target.src = target.dataset.src;
  }), { rootMargin: '400px' });
  document.querySelectorAll('iframe[data-src]').forEach((frame) => seen.observe(frame));
});

// A scene over a picture is shown when it is drawn; without WebGL the picture stays.
addEventListener('message', ({ source, data }) => {
  if (data !== 'vizlight-ready') return;
  document.querySelectorAll('.divided iframe').forEach((frame) => {
    if (frame.contentWindow === source) frame.classList.add('ready');
  });
});
