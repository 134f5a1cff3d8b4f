// A section of the page; null in a list of them means that the document has nothing for it.
export interface Section {
  id: string;
  title: string;
  content: HTMLElement[];
}
