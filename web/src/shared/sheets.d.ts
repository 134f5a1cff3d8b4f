// What web/build.mjs bundles as a text.
declare module '*.css?text' {
  const sheet: string;
  export default sheet;
}
